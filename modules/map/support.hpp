// SPDX-License-Identifier: BSD-3-Clause
// How much a plane of the map is to be believed when it is asked what the room looks like.
#pragma once

#include <cmath>

#include "core/plane_map.hpp"

namespace planemap::map {

/// Whether its numbers make a plane: what a file or a message holds may be anything.
inline bool is_plane(const MapPlane& plane) {
    return std::abs(plane.normal.cast<double>().norm() - 1) < 1e-3 && plane.center.allFinite() &&
           plane.half_extents.allFinite() && std::isfinite(plane.area) && std::isfinite(plane.angle);
}

/// Of a plane that so many keyframes saw: a third of it for one look, half for two, all for many. What one
/// view saw may be a mirror's image, a bad match or stray depth; what twenty saw is there.
inline double trust(int keyframes) {
    constexpr double kHalf = 2;  ///< looks at which half is believed
    const double looks = keyframes < 1 ? 1 : keyframes;
    return looks / (looks + kHalf);
}

/// Area that a plane of the map counts for, square metres.
inline double supported_area(const MapPlane& plane) {
    return static_cast<double>(plane.area) * trust(plane.keyframes);
}

}  // namespace planemap::map
