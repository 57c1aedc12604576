// SPDX-License-Identifier: BSD-3-Clause
// An outline in another frame than its owner's, and the rectangle around it.
#pragma once

#include <Eigen/Geometry>

#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/outline.hpp"
#include "core/geometry/pose.hpp"

namespace planemap {

/// What lies in the x and y of frame a, in those of frame b: seen along b's z, so turned and foreshortened.
/// Metres, or what unit both have.
Outline projected(const Pose& b_from_a, Outline outline_a);

/// The rectangle around all vertices, along x and y; empty (isEmpty()) without any. A vertex that is NaN may
/// be left out.
Eigen::AlignedBox2d bounds(const Outline& outline);
Eigen::AlignedBox2d bounds(const FlatPolygon& polygon);

}  // namespace planemap
