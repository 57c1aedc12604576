// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "core/trajectory.hpp"

namespace planemap::test {

/// A camera that walks a circle of 2 m radius about z, looking along its way, `rounds` times in 10 s each; 30
/// poses a second.
inline Trajectory circle(double rounds) {
    Trajectory path;
    for (int i = 0; i < static_cast<int>(300 * rounds); ++i) {
        const double angle = 2 * 3.14159265358979 * i / 300;
        Pose pose = Pose::Identity();
        pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        pose.translation() = 2 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        path.push_back({1000000 + std::llround(i * 1e6 / 30), pose});
    }
    return path;
}

/// Every pose moved by a rigid motion of the world.
inline Trajectory moved(Trajectory path, const Pose& motion) {
    for (StampedPose& pose : path) pose.world_from_camera = motion * pose.world_from_camera;
    return path;
}

}  // namespace planemap::test
