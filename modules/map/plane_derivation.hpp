// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "map/evidence_shape.hpp"
#include "map/plane_estimate.hpp"

namespace planemap::map {

/// Which estimates become planes of a map, and with what outline.
struct DerivationRules {
    OutlineOptions outline;
    double min_area_m2;
    double min_single_m2;  ///< the same for planes that only one keyframe saw
    int min_keyframes;
};

/// Where another plane meets one, world frame.
struct Meeting {
    IntersectionLine line;
    double reach_m = 0;  ///< see meeting_reach()
};

/// An estimate as a plane of the map, with an outline as exact as its cells, to be compared with others;
/// nothing if it is too small or too seldom seen.
std::optional<MapPlane> derived_plane(const PlaneEstimate& estimate, const DerivationRules& rules);

/// The same as others see it: with straight edges, and ending where others meet it. Nothing if too little is
/// left of it.
std::optional<MapPlane> ended_plane(const PlaneEstimate& estimate, const DerivationRules& rules,
                                    const std::vector<Meeting>& meetings);

/// True when an estimate is no more than numbers away from the plane that was derived from it: few cells
/// changed, and no part moved to note against the plane `as_drawn` that its outline was traced on.
bool keeps_outline(const PlaneEstimate& estimate, const MapPlane& derived, const Plane& as_drawn);

/// Gives the plane the estimate's numbers; the outline moves along.
void move_to_estimate(MapPlane& derived, const PlaneEstimate& estimate);

}  // namespace planemap::map
