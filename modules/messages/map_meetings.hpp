// SPDX-License-Identifier: BSD-3-Clause
// What maps of today's format and of earlier ones share. Where planes meet is the same for who sends a map
// and who hears it.
#pragma once

#include <optional>

#include "core/geometry/plane_intersection.hpp"
#include "core/plane_map.hpp"

namespace planemap::messages {

/// The line that two planes share; its zero is the point nearest to the centre of a. Nothing for planes that
/// are parallel.
inline std::optional<Line> shared_line(const MapPlane& a, const MapPlane& b) {
    constexpr double kLeastSine = 1e-3;
    return common_line(a.plane(), b.plane(), a.center.cast<double>(), kLeastSine);
}

/// The point that three planes share. Nothing for planes that nearly share a line.
inline std::optional<Eigen::Vector3d> shared_point(const MapPlane& a, const MapPlane& b, const MapPlane& c) {
    constexpr double kLeastVolume = 1e-4;
    return common_point(a.plane(), b.plane(), c.plane(), kLeastVolume);
}

/// A message's up. Throws MessageError for what is neither zero nor a unit vector.
Eigen::Vector3f checked_up(const float* up_world);

}  // namespace planemap::messages
