// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <planemap/map_size_t.hpp>
#include <thread>
#include <utility>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::octomap {

namespace {

constexpr std::int64_t kPublishPeriodUs = 5000000;
constexpr std::chrono::milliseconds kPatience{250};  // of a stop

// Recent frames. In one process a keyframe comes right after its frame; between processes the odometry may
// have a dozen frames before it, and at a fifth of the camera's rate those are two seconds of frames.
constexpr std::size_t kFramesInHandler = 16, kFramesInBackground = 128;
constexpr std::size_t kRecentBytes = 64 << 20;  // of frames beyond the sixteen
// Keyframes without a pose: as many as the graph's own queue holds.
constexpr std::size_t kMaxWaiting = 256;

}  // namespace

OctomapShell::OctomapShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                           const OctomapOptions& options, Building building)
    : bus_(bus),
      decoder_(std::move(decoder)),
      builder_(std::make_unique<OctomapBuilder>(options)),
      resolution_m_(options.resolution_m) {
    if (building == Building::kInBackground) worker_ = std::make_unique<OctomapWorker>(*builder_);
    decoder_->subscribe(
        status_, 8, [this](const auto& frame) { on_frame(frame); }, false);
    bus_.subscribe(messages::channels::kKeyframe,
                   status_.guard([this](const messages::RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(messages::channels::kTrajectory,
                   status_.guard([this](const messages::RawMessage& m) { on_trajectory(m); }), 16);
}

OctomapShell::~OctomapShell() {
    if (!worker_) return;
    worker_.reset();
    // To free millions of nodes one by one takes longer than a stop may: the end of the process does not wait
    // for it.
    std::thread([left = std::move(builder_)] {}).detach();
}

void OctomapShell::on_frame(const std::shared_ptr<const messages::Frame>& frame) {
    recent_.push_back({frame, frame->image_bytes()});
    recent_bytes_ += recent_.back().bytes;
    const std::size_t most = worker_ ? kFramesInBackground : kFramesInHandler;
    while (recent_.size() > most || (recent_.size() > kFramesInHandler && recent_bytes_ > kRecentBytes)) {
        recent_bytes_ -= recent_.front().bytes;
        recent_.pop_front();
    }
}

void OctomapShell::drop(const char* reason, std::int64_t count) {
    status_.dropped(count);
    status_.lost(reason, count);
}

void OctomapShell::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t received = messages::decode<keyframe_t>(message.bytes);
    if (!keyframe_guard_.admits(received.session, received.seq, received.utime, message.bytes)) return;
    watch_.came(received.id, received.previous_id, received.utime);
    const auto recent = std::find_if(recent_.begin(), recent_.end(),
                                     [&](const Recent& r) { return r.frame->utime() == received.utime; });
    if (recent == recent_.end()) return drop("keyframes whose frame was gone");
    Waiting keyframe{recent->frame, nullptr};
    if (worker_) {
        const messages::ModuleStatus::Work work(status_);
        keyframe = {nullptr, std::make_shared<StoredScan>(recent->frame->depth(), recent->frame->camera())};
    }
    waiting_[received.id] = std::move(keyframe);
    if (waiting_.size() > kMaxWaiting) {
        waiting_.erase(waiting_.begin());
        drop("keyframes that never got a pose");
    }
}

void OctomapShell::on_trajectory(const messages::RawMessage& message) {
    const trajectory_t received = messages::decode<trajectory_t>(message.bytes);
    const KeyframeTrajectory trajectory = messages::from_message(received);
    if (!trajectory_guard_.admits(received.session, received.seq, std::nullopt, message.bytes)) return;
    watch_.named(trajectory, messages::now_us());
    last_utime_ = trajectory.utime;
    last_revision_ = trajectory.revision;
    if (!worker_) builder_->update(trajectory);
    for (const KeyframePose& pose : trajectory.keyframes) {
        const auto waiting = waiting_.find(pose.id);
        if (waiting == waiting_.end()) continue;
        const Waiting keyframe = waiting->second;
        waiting_.erase(waiting);
        add(pose.id, keyframe, pose.world_from_camera);
    }
    if (worker_) worker_->update(trajectory);
    unpublished_ = true;
}

void OctomapShell::add(int id, const Waiting& keyframe, const Pose& world_from_camera) {
    if (worker_) {
        if (!worker_->add(id, keyframe.scan, world_from_camera))
            return drop("keyframes that the OctoMap was too slow for");
        return status_.published();
    }
    const DepthImage& depth = keyframe.frame->depth();
    const messages::ModuleStatus::Work work(status_);
    if (builder_->add(id, depth, keyframe.frame->camera(), world_from_camera)) {
        status_.published();
    } else {
        drop("keyframes that the OctoMap refused");
    }
}

int OctomapShell::poll() {
    constexpr int kIdleMs = 100;
    watch_.tell(messages::now_us());
    if (worker_) {
        if (const auto state = worker_->newer_state()) publish(*state);
    } else if (unpublished_ && messages::now_us() - last_publish_us_ >= kPublishPeriodUs) {
        publish(state());
    }
    return kIdleMs;
}

void OctomapShell::finish() {
    drop("keyframes that never got a pose", static_cast<std::int64_t>(waiting_.size()));
    waiting_.clear();
    if (!worker_) return publish(state());
    worker_->finish(kPatience);
    const auto state = worker_->newer_state();
    if (state) publish(*state);
    if (!state || !state->is_up_to_date)
        spdlog::warn("octomap: stopped while some keyframes were not where the last trajectory has them");
}

OctomapState OctomapShell::state() {
    {
        const messages::ModuleStatus::Work work(status_);
        builder_->flush();
    }
    OctomapState state;
    state.sizes = builder_->sizes();
    state.keyframes = builder_->keyframes_in_tree();
    state.frozen = builder_->frozen();
    state.utime = last_utime_;
    state.revision = last_revision_;
    state.is_up_to_date = true;
    return state;
}

void OctomapShell::publish(const OctomapState& state) {
    drop("keyframes that the OctoMap refused", static_cast<std::int64_t>(state.refused - refused_));
    status_.lost("depth images of old keyframes, which stay at their pose",
                 static_cast<std::int64_t>(state.frozen - frozen_));
    refused_ = state.refused;
    frozen_ = state.frozen;

    map_size_t message;
    message.utime = state.utime;
    message.seq = seq_++;
    message.session = bus_.session();
    message.resolution_m = resolution_m_;
    message.n_nodes = static_cast<std::int64_t>(state.sizes.nodes);
    message.n_occupied_leaves = static_cast<std::int64_t>(state.sizes.occupied_leaves);
    message.memory_bytes = static_cast<std::int64_t>(state.sizes.memory_bytes);
    message.bt_bytes = static_cast<std::int64_t>(state.sizes.bt_bytes);
    message.ot_bytes = static_cast<std::int64_t>(state.sizes.ot_bytes);
    message.n_keyframes = static_cast<std::int32_t>(state.keyframes);
    message.revision = state.revision;
    bus_.publish(messages::channels::kOctomapSize, message);
    status_.set_text(std::to_string(state.keyframes) + " keyframes in " +
                     std::to_string(state.sizes.memory_bytes / 1024) + " KiB of memory, " +
                     std::to_string(state.sizes.bt_bytes) + " B .bt" +
                     (state.is_up_to_date ? "" : ", some not yet where they belong"));
    last_publish_us_ = messages::now_us();
    unpublished_ = false;
}

}  // namespace planemap::octomap
