// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/waiting_scans.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace planemap::octomap {

namespace {

// Keyframes that the graph let go, which looks may still be tracked against.
constexpr int kReplacedKept = 1000;

}  // namespace

void WaitingScans::announce(int keyframe_id) {
    if (keyframe_id > newest_id_) looks_since_ = 0;
    newest_id_ = std::max(newest_id_, keyframe_id);
}

bool WaitingScans::add_keyframe(int id, std::shared_ptr<const StoredScan> scan) {
    keyframes_[id] = std::move(scan);
    if (keyframes_.size() <= kMost) return true;
    keyframes_.erase(keyframes_.begin());
    return false;
}

bool WaitingScans::add_look(const Look& look, std::shared_ptr<const StoredScan> scan) {
    looks_.push_back(
        {{newest_id_, ++looks_since_}, {look.keyframe_id, look.keyframe_from_camera}, std::move(scan)});
    if (looks_.size() <= kMost) return true;
    looks_.pop_front();
    return false;
}

void WaitingScans::give_keyframes(const KeyframeTrajectory& trajectory, const Taker& take) {
    poses_.update(trajectory.keyframes);
    poses_.keep_replaced([&](int id) { return id > newest_id_ - kReplacedKept; });
    for (const KeyframePose& pose : trajectory.keyframes) {
        const auto waiting = keyframes_.find(pose.id);
        if (waiting == keyframes_.end()) continue;
        const std::shared_ptr<const StoredScan> scan = waiting->second;
        keyframes_.erase(waiting);
        take(pose.id, scan, pose.world_from_camera, {pose.id, Pose::Identity()});
    }
}

void WaitingScans::give_looks(const Taker& take) {
    while (!looks_.empty()) {
        const WaitingLook& look = looks_.front();
        const std::optional<Pose> anchor = poses_.pose_of(look.anchor.keyframe_id);
        if (!anchor || keyframes_.contains(look.id.keyframe)) return;
        take(look.id, look.scan, *anchor * look.anchor.keyframe_from_camera, look.anchor);
        looks_.pop_front();
    }
}

void WaitingScans::start_over() {
    poses_ = {};
    looks_.clear();
}

std::size_t WaitingScans::keyframes_among(const std::set<int>& ids) const {
    return static_cast<std::size_t>(
        std::count_if(keyframes_.begin(), keyframes_.end(),
                      [&](const auto& waiting) { return ids.contains(waiting.first); }));
}

}  // namespace planemap::octomap
