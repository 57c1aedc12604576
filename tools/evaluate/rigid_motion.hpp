// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pose.hpp"

namespace planemap {

/// The rigid motion to_from_from that lays points on their counterparts with least squares (Horn; Umeyama
/// 1991, without scale). `correlation` is the sum of (to - to_mean) (from - from_mean)^T; whoever fits
/// rotations, too, adds R_to R_from^T for each pair. Where the correlation leaves a rotation free, one of the
/// best is taken.
Pose rigid_motion(const Eigen::Matrix3d& correlation, const Eigen::Vector3d& to_mean,
                  const Eigen::Vector3d& from_mean);

}  // namespace planemap
