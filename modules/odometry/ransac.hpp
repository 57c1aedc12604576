// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "odometry/alignment.hpp"
#include "odometry/options.hpp"

namespace planemap::odometry {

struct MotionRansacOptions {
    int max_iterations = 200;
    double confidence = 0.999;  ///< stop when a better sample is less likely than 1 - confidence
    double inlier_px;           ///< reprojection error of an inlier
    int min_inliers;            ///< fewer: no motion
    std::uint64_t seed;
};

/// What odometry's options say of it.
MotionRansacOptions motion_ransac_options(const OdometryOptions& options);

/// The motion that most of the points agree on: three points with depth in both views are a sample, the rest
/// vote by reprojection error and, where depth is known, by inverse depth (within 4 sigma). Returns
/// camera_from_keyframe, or nothing when too few agree. Deterministic for a seed.
std::optional<Pose> ransac_motion(const PinholeCamera& camera, std::span<const PointTerm> points,
                                  const MotionRansacOptions& options);

}  // namespace planemap::odometry
