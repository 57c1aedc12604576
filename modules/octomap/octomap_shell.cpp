// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

#include <algorithm>
#include <planemap/map_size_t.hpp>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap {

namespace {
constexpr std::int64_t kPublishPeriodUs = 5000000;
}

OctomapShell::OctomapShell(Bus& bus, std::shared_ptr<FrameDecoder> decoder, const OctomapOptions& options)
    : bus_(bus), decoder_(std::move(decoder)), builder_(options), resolution_m_(options.resolution_m) {
    decoder_->subscribe(
        status_, 8, [this](const auto& frame) { on_frame(frame); }, false);
    bus_.subscribe(channels::kKeyframe, status_.guard([this](const RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(channels::kTrajectory, status_.guard([this](const RawMessage& m) { on_trajectory(m); }),
                   16);
}

void OctomapShell::on_frame(const std::shared_ptr<const Frame>& frame) {
    recent_.push_back(frame);
    if (recent_.size() > kRecentFrames) recent_.pop_front();
}

void OctomapShell::on_keyframe(const RawMessage& message) {
    const keyframe_t received = decode<keyframe_t>(message.bytes);
    if (!keyframe_guard_.admits(received.seq, received.utime, message.bytes)) return;
    const auto frame = std::find_if(recent_.begin(), recent_.end(),
                                    [&](const auto& f) { return f->utime() == received.utime; });
    if (frame == recent_.end()) {
        status_.dropped();
        return;
    }
    waiting_[received.id] = *frame;
    if (waiting_.size() > kMaxWaiting) {
        waiting_.erase(waiting_.begin());
        status_.dropped();
    }
}

void OctomapShell::on_trajectory(const RawMessage& message) {
    const trajectory_t received = decode<trajectory_t>(message.bytes);
    const KeyframeTrajectory trajectory = from_message(received);
    if (!trajectory_guard_.admits(received.seq, std::nullopt, message.bytes)) return;
    last_utime_ = trajectory.utime;
    last_revision_ = trajectory.revision;
    builder_.update(trajectory);
    for (const KeyframePose& pose : trajectory.keyframes) {
        const auto waiting = waiting_.find(pose.id);
        if (waiting == waiting_.end()) continue;
        const std::shared_ptr<const Frame> frame = waiting->second;
        waiting_.erase(waiting);
        const DepthImage& depth = frame->depth();
        const ModuleStatus::Work work(status_);
        if (builder_.add(pose.id, depth, frame->camera(), pose.world_from_camera)) {
            ++keyframes_;
            status_.published();
        } else {
            status_.dropped();
        }
    }
    unpublished_ = true;
}

int OctomapShell::poll() {
    if (unpublished_ && now_us() - last_publish_us_ >= kPublishPeriodUs) publish_size();
    return 100;
}

void OctomapShell::finish() {
    publish_size();
}

void OctomapShell::publish_size() {
    {
        const ModuleStatus::Work work(status_);
        builder_.flush();
    }
    const OctomapSizes sizes = builder_.sizes();
    map_size_t message;
    message.utime = last_utime_;
    message.seq = seq_++;
    message.resolution_m = resolution_m_;
    message.n_nodes = static_cast<std::int64_t>(sizes.nodes);
    message.n_occupied_leaves = static_cast<std::int64_t>(sizes.occupied_leaves);
    message.memory_bytes = static_cast<std::int64_t>(sizes.memory_bytes);
    message.bt_bytes = static_cast<std::int64_t>(sizes.bt_bytes);
    message.ot_bytes = static_cast<std::int64_t>(sizes.ot_bytes);
    message.n_keyframes = keyframes_;
    message.revision = last_revision_;
    bus_.publish(channels::kOctomapSize, message);
    status_.set_text(std::to_string(sizes.memory_bytes / 1024) + " KiB in memory, " +
                     std::to_string(sizes.bt_bytes) + " B .bt");
    last_publish_us_ = now_us();
    unpublished_ = false;
}

}  // namespace planemap
