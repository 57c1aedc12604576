// SPDX-License-Identifier: BSD-3-Clause
#include "graph/published_trajectory.hpp"

namespace planemap::graph {

void PublishedTrajectory::update(const Keyframes& keyframes, UnionFind<int> parts, int loop_closures) {
    const std::vector<Pose>& poses = keyframes.poses();
    if (has_moved(poses)) {
        ++trajectory_.revision;
        revision_poses_ = poses;
    } else if (revision_poses_.size() < poses.size()) {
        revision_poses_.push_back(poses.back());
    }
    trajectory_.utime = keyframes.back().utime;
    trajectory_.loop_closures = loop_closures;
    trajectory_.world_from_odom =
        orthonormalised(poses.back() * keyframes.back().odom_from_camera.inverse(Eigen::Isometry));
    trajectory_.keyframes.resize(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const int number = static_cast<int>(i);
        trajectory_.keyframes[i] = {keyframes[number].id, keyframes[number].utime, poses[i],
                                    keyframes[parts.find(number)].id};
    }
}

bool PublishedTrajectory::has_moved(const std::vector<Pose>& poses) const {
    for (std::size_t i = 0; i < revision_poses_.size(); ++i) {
        const Pose change = revision_poses_[i].inverse(Eigen::Isometry) * poses[i];
        if (change.translation().norm() > options_.revision_m ||
            rotation_angle(change) > options_.revision_rad)
            return true;
    }
    return false;
}

void PublishedTrajectory::remove(int node) {
    if (at(node) < revision_poses_.size()) revision_poses_.erase(revision_poses_.begin() + node);
    if (at(node) < trajectory_.keyframes.size())
        trajectory_.keyframes.erase(trajectory_.keyframes.begin() + node);
}

}  // namespace planemap::graph
