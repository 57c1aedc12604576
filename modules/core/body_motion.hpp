// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/geometry/pose.hpp"

namespace planemap {

/// Where a robot's body is and how it moves, as bot_core.pose_t has it.
struct BodyMotion {
    /// Body frame (x forward, y left, z up) to the local frame, in which the body lay at the identity at
    /// first; smooth, no loop closure moves it.
    Pose local_from_body = Pose::Identity();
    Eigen::Vector3d velocity_local = Eigen::Vector3d::Zero();      ///< of the body's origin, m/s
    Eigen::Vector3d rotation_rate_body = Eigen::Vector3d::Zero();  ///< rad/s, body frame
};

}  // namespace planemap
