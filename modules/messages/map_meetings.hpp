// SPDX-License-Identifier: BSD-3-Clause
// What maps of today's format and of earlier ones share. Where planes meet is the same for who sends a map
// and who hears it.
#pragma once

#include <cmath>
#include <optional>

#include "core/geometry/plane_intersection.hpp"
#include "core/plane_map.hpp"
#include "messages/checks.hpp"
#include "messages/convert.hpp"

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

/// What a map's message says of it beside its planes. Throws MessageError.
template <typename Message>
PlaneMap map_without_planes(const Message& message) {
    PlaneMap map;
    map.utime = checked_utime(message.utime, "plane_map.utime");
    map.revision = message.revision;
    require(message.component >= 0, "component", "is negative");
    map.component = message.component;
    map.up = Eigen::Vector3f(message.up);
    require(map.up.allFinite() && (map.up.isZero() || std::abs(map.up.norm() - 1) < 1e-3f), "up",
            "is neither zero nor a unit vector");
    return map;
}

}  // namespace planemap::messages
