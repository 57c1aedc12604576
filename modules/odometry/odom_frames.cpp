// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odom_frames.hpp"

#include <algorithm>

namespace planemap::odometry {

namespace {

constexpr std::size_t kMostApart = 64;  // odom frames beside the first that are known

}  // namespace

void OdomFrames::add(const Keyframe& keyframe) {
    const Start start{keyframe.id, keyframe.utime, keyframe.odom_from_camera};
    if (!first_) {
        first_ = start;
        first_chain_ = keyframe.chain;
    } else if (keyframe.chain == keyframe.id) {
        apart_[keyframe.chain] = start;
        if (apart_.size() > kMostApart) apart_.erase(apart_.begin());
    }
}

void OdomFrames::hear(const KeyframeTrajectory& trajectory) {
    if (!first_) return;
    const auto named = [&](const Start& start) {
        const auto found = std::find_if(
            trajectory.keyframes.begin(), trajectory.keyframes.end(),
            [&](const KeyframePose& pose) { return pose.id == start.id && pose.utime == start.utime; });
        return found == trajectory.keyframes.end() ? nullptr : &*found;
    };
    const KeyframePose* first = named(*first_);
    if (first == nullptr) return;
    odom_from_world_ = first_->odom_from_camera * first->world_from_camera.inverse();
    std::erase_if(apart_, [&](const auto& entry) {
        const auto& [chain, start] = entry;
        const KeyframePose* pose = named(start);
        if (pose == nullptr || pose->component != first->component) return false;
        first_from_odom_[chain] =
            *odom_from_world_ * pose->world_from_camera * start.odom_from_camera.inverse(Eigen::Isometry);
        return true;
    });
    while (first_from_odom_.size() > kMostApart) first_from_odom_.erase(first_from_odom_.begin());
}

std::optional<Pose> OdomFrames::first_from(int chain) const {
    if (chain == first_chain_) return Pose::Identity();
    const auto known = first_from_odom_.find(chain);
    if (known == first_from_odom_.end()) return std::nullopt;
    return known->second;
}

}  // namespace planemap::odometry
