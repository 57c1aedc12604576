// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <planemap/keyframe_t.hpp>
#include <planemap/look_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <utility>

#include "core/components.hpp"
#include "core/files.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::octomap {

namespace {

constexpr std::int64_t kPublishPeriodUs = 5000000;
constexpr std::chrono::milliseconds kPatience{250};  // of a stop

}  // namespace

OctomapShell::OctomapShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                           const OctomapOptions& options, Building building, const OctomapFiles& files)
    : bus_(bus),
      decoder_(std::move(decoder)),
      tree_(options, building),
      recent_(building == Building::kInBackground ? RecentFrames::kInBackground : RecentFrames::kInHandler),
      resolution_m_(options.resolution_m),
      max_keyframes_(static_cast<std::size_t>(options.max_keyframes)),
      output_(files.output) {
    if (!files.journal.empty()) {
        journal_ = std::make_unique<ScanJournal>(bus, files.journal);
        resume();
    }
    decoder_->subscribe(
        status_, 8, [this](const auto& frame) { recent_.add(frame); }, false);
    bus_.subscribe(messages::channels::kKeyframe,
                   status_.guard([this](const messages::RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(messages::channels::kLook,
                   status_.guard([this](const messages::RawMessage& m) { on_look(m); }), 256);
    bus_.subscribe(messages::channels::kTrajectory,
                   status_.guard([this](const messages::RawMessage& m) { on_trajectory(m); }), 16);
}

void OctomapShell::drop(const char* reason, std::int64_t count) {
    status_.dropped(count);
    status_.lost(reason, count);
}

void OctomapShell::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t received = messages::decode<keyframe_t>(message.bytes);
    if (!keyframe_guard_.admits(received, message.bytes, watch_.has(received.id))) return;
    keyframe_guard_.took(received);
    watch_.came(received.id, received.previous_id, received.utime);
    waiting_.announce(received.id);
    const std::shared_ptr<const messages::Frame> frame = recent_.at(received.utime);
    if (!frame) return drop("keyframes whose frame was gone");
    if (journal_) journal_->keep(*frame, message.bytes);
    if (!waiting_.add_keyframe(received.id, scan_of(*frame))) drop("keyframes that never got a pose");
}

std::shared_ptr<const StoredScan> OctomapShell::scan_of(const messages::Frame& frame) {
    const messages::ModuleStatus::Work work(status_);
    return std::make_shared<StoredScan>(frame.depth(), frame.camera());
}

/// A look that saw what changed: its depth comes into the tree, too.
void OctomapShell::on_look(const messages::RawMessage& message) {
    const look_t received = messages::decode<look_t>(message.bytes);
    const Look look = messages::from_message(received);
    if (look.number == 0 || received.session != keyframe_guard_.session()) return;
    const std::shared_ptr<const messages::Frame> frame = recent_.at(look.utime);
    if (!frame) return drop("looks whose frame was gone");
    if (!waiting_.add_look(look, scan_of(*frame))) drop("looks whose keyframe never got a pose");
    waiting_.give_looks(adder());
}

void OctomapShell::on_trajectory(const messages::RawMessage& message) {
    const trajectory_t received = messages::decode<trajectory_t>(message.bytes);
    const KeyframeTrajectory trajectory = messages::from_message(received);
    if (!trajectory_guard_.admits(received.session, received.seq, std::nullopt, message.bytes)) return;
    if (journal_) journal_->hear(message.bytes);
    take(trajectory);
}

/// The tree is of the component with the most keyframes: where others lie in it is not known. Their keyframes
/// wait.
void OctomapShell::take(const KeyframeTrajectory& all) {
    const int largest = largest_component(all);
    const bool stands_alone = std::any_of(all.keyframes.begin(), all.keyframes.end(), [&](const auto& pose) {
        return largest != component_ && pose.component == component_;
    });
    if (stands_alone) start_over();
    component_ = largest;
    const KeyframeTrajectory trajectory = of_component(all, largest);
    watch_.named(all, messages::now_us());
    named_.clear();
    for (const KeyframePose& pose : all.keyframes) named_.insert(pose.id);
    tree_.begin_update(trajectory);
    waiting_.give_keyframes(trajectory, adder());
    waiting_.give_looks(adder());
    tree_.end_update(trajectory);
    unpublished_ = true;
}

/// Another component has become the largest: what the tree holds lies nowhere in it.
void OctomapShell::start_over() {
    drop("keyframes of a component that is the largest no more",
         static_cast<std::int64_t>(tree_.start_over()));
    waiting_.start_over();
    frozen_ = refused_ = 0;
}

/// Takes keyframes, their depth and their poses from the process before.
void OctomapShell::resume() {
    ScanJournal::Earlier earlier = journal_->earlier();
    waiting_.resume(std::move(earlier.scans));
    for (const ScanJournal::Came& keyframe : earlier.keyframes)
        watch_.came(keyframe.id, keyframe.previous_id, keyframe.utime);
    if (!earlier.newest.empty()) {
        const auto last = messages::decode<keyframe_t>(earlier.newest);
        keyframe_guard_.resume(last, earlier.newest);
    }
    if (earlier.trajectory.empty()) return;
    const auto last = messages::decode<trajectory_t>(earlier.trajectory);
    trajectory_guard_.resume(last.session, last.seq, std::nullopt, earlier.trajectory);
    spdlog::info("octomap: goes on with {} keyframes of {}", waiting_.keyframes(), journal_->file().string());
    take(messages::from_message(last));
}

/// octomap.bt, as planemap-run leaves it, beside the map.
void OctomapShell::write_tree() {
    if (output_.empty() || tree_.builder().keyframes_in_tree() == 0) return;
    std::filesystem::create_directories(output_);
    write_file(output_ / "octomap.bt", tree_.builder().bt());
}

void OctomapShell::add(ScanId id, const std::shared_ptr<const StoredScan>& scan,
                       const Pose& world_from_camera, const ScanAnchor& anchor) {
    std::optional<messages::ModuleStatus::Work> work;
    if (!tree_.is_in_background()) work.emplace(status_);
    if (tree_.add(id, scan, world_from_camera, anchor)) return status_.published();
    drop(tree_.is_in_background() ? "keyframes that the OctoMap was too slow for"
                                  : "keyframes that the OctoMap refused");
}

int OctomapShell::poll() {
    constexpr int kIdleMs = 100;
    watch_.tell(messages::now_us());
    if (journal_) journal_->tend(named_, max_keyframes_, status_);
    if (tree_.is_in_background()) {
        if (const auto state = tree_.newer_state()) publish(*state);
    } else if (unpublished_ && messages::now_us() - last_publish_us_ >= kPublishPeriodUs) {
        bring_up_to_date_and_publish();
    }
    return kIdleMs;
}

void OctomapShell::finish() {
    const std::size_t others = waiting_.keyframes_among(named_);
    drop("keyframes of components other than the largest", static_cast<std::int64_t>(others));
    drop("keyframes that never got a pose", static_cast<std::int64_t>(waiting_.keyframes() - others));
    waiting_.clear_keyframes();
    if (journal_) journal_->save_trajectory();
    if (!tree_.is_in_background()) {
        bring_up_to_date_and_publish();
        return write_tree();
    }
    tree_.finish(kPatience);
    const auto state = tree_.newer_state();
    if (state) publish(*state);
    write_tree();
    if (!state || !state->is_up_to_date)
        spdlog::warn("octomap: stopped while some keyframes were not where the last trajectory has them");
}

void OctomapShell::bring_up_to_date_and_publish() {
    OctomapState state;
    {
        const messages::ModuleStatus::Work work(status_);
        state = tree_.state_up_to_date();
    }
    publish(state);
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
