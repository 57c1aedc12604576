// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/geometry/box.hpp"
#include "core/geometry/moments.hpp"
#include "core/geometry/outline.hpp"

namespace planemap {

/// A planar region pi = [n, d, N, B] (paper section 2.1), with the exact moments of its points, its outline
/// and the spread about the plane. All in one frame, which the owner names (camera_..., world_...).
struct PlanarRegion {
    Plane plane;      ///< in a camera frame the normal points towards the sensor
    Moments moments;  ///< of the inliers; moments.count is the paper's N
    Box box;          ///< z axis along the plane's normal, origin on the plane
    Outline outline;  ///< in the box's x and y, metres
    double rms = 0;   ///< distance of the inliers to the plane, metres
};

/// The region in frame b.
PlanarRegion operator*(const Pose& b_from_a, const PlanarRegion& region_a);

/// True when plane, moments, box and outline are finite and consistent: unit normal, at least three points,
/// half extents >= 0, rings of at least three vertices. Use it on what comes off the bus.
bool is_valid(const PlanarRegion& region);

/// Distance from a point to the region: to its outline within the plane, and to the plane. Metres.
/// A region without outline is taken to fill its box.
double distance(const PlanarRegion& region, const Eigen::Vector3d& p);

}  // namespace planemap
