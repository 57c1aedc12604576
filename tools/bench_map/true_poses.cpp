// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/true_poses.hpp"

#include <algorithm>

#include "core/geometry/rigid_fit.hpp"
#include "pipeline/given_poses.hpp"

namespace planemap::bench_map {

namespace {

/// Poses of the keyframes that both know.
std::vector<std::pair<Pose, Pose>> common(const KeyframeTrajectory& to, const KeyframeTrajectory& from) {
    std::vector<std::pair<Pose, Pose>> pairs;
    for (const KeyframePose& a : to.keyframes) {
        const auto b = std::find_if(from.keyframes.begin(), from.keyframes.end(),
                                    [&](const KeyframePose& pose) { return pose.id == a.id; });
        if (b != from.keyframes.end()) pairs.emplace_back(a.world_from_camera, b->world_from_camera);
    }
    return pairs;
}

}  // namespace

KeyframeTrajectory at_poses(const std::vector<Keyframe>& keyframes, const Trajectory& trajectory) {
    KeyframeTrajectory poses;
    for (const Keyframe& keyframe : keyframes) {
        const std::optional<Pose> pose = pipeline::given_pose(trajectory, keyframe.utime);
        if (!pose) continue;
        poses.keyframes.push_back({keyframe.id, keyframe.utime, *pose});
        poses.utime = keyframe.utime;
    }
    return poses;
}

std::optional<Pose> alignment(const KeyframeTrajectory& to, const KeyframeTrajectory& from) {
    const std::vector<std::pair<Pose, Pose>> pairs = common(to, from);
    if (pairs.empty()) return std::nullopt;
    Eigen::Vector3d to_mean = Eigen::Vector3d::Zero(), from_mean = Eigen::Vector3d::Zero();
    for (const auto& [a, b] : pairs) to_mean += a.translation(), from_mean += b.translation();
    to_mean /= static_cast<double>(pairs.size());
    from_mean /= static_cast<double>(pairs.size());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& [a, b] : pairs) {
        sum += (a.translation() - to_mean) * (b.translation() - from_mean).transpose();
        sum += a.linear() * b.linear().transpose();
    }
    return rigid_fit(sum, to_mean, from_mean);
}

}  // namespace planemap::bench_map
