// SPDX-License-Identifier: BSD-3-Clause
// How planes of a map lie to each other, and how well that is known.
#pragma once

#include <optional>
#include <vector>

#include "core/plane_map.hpp"

namespace planemap::map {

/// Standard deviations of a plane: of its place along the normal, metres, at the centre of its box, and of
/// its slopes along the box's x and y, radians.
///
/// A stored map has no covariances, so these come from what it has: readings of one keyframe err alike (the
/// sensor's bias, the pose), so that each keyframe that saw the plane counts as one look that is off by the
/// plane's rms, over the half extents of its box. What all looks have in common is not in it: how far the
/// trajectory drifted between two planes, and a sensor whose depth is off everywhere.
struct PlaneCertainty {
    double offset = 0;
    Eigen::Vector2d slopes = Eigen::Vector2d::Zero();

    /// Of the place of the infinite plane at a point of it, metres: more the further from the box's centre.
    double offset_at(const MapPlane& plane, const Eigen::Vector3d& p_world) const;
    /// Of the normal's tilt towards a direction, radians; the larger slope for a direction that is zero.
    double tilt_towards(const MapPlane& plane, const Eigen::Vector3d& direction_world) const;
};

/// Nothing where the map does not say by what the plane scatters, who saw it or how far it reaches.
std::optional<PlaneCertainty> certainty_of(const MapPlane& plane);

/// Which sides of two parallel planes were seen.
enum class Sides {
    kFacing,      ///< each lies before the other: what is between them was seen from both (a room)
    kBackToBack,  ///< each lies behind the other: a wall's two sides, a table top and its lower side
    kSameWay,     ///< both look the same way: a step
};

/// How two planes lie to each other: what Tables 3 and 4 of the paper measure.
struct PlaneRelation {
    /// Between the normals, radians in [0, pi]. Normals point to where a plane was seen from, so two walls of
    /// a room that face each other are pi apart, the two sides of a partition too, and a floor and a wall
    /// pi / 2.
    double angle = 0;
    std::optional<double> angle_sigma;  ///< standard deviation, radians; nothing: not known, see certainty_of

    /// What follows is of planes parallel within 15 deg (kParallel_rad), whichever way they face. Others meet
    /// somewhere, and have no one distance; see MapQueries::gap().
    ///
    /// Metres between the infinite planes along their mean normal, through the middle of what of the outlines
    /// lies opposite; where nothing does, through the middle between the centres of their boxes.
    std::optional<double> distance;
    std::optional<double> distance_sigma;  ///< metres; nothing: not known, see certainty_of()
    double least = 0, most = 0;            ///< of the distance over what lies opposite; without, the distance
    double opposite = 0;                   ///< area of that, seen along the mean normal, square metres
    Sides sides = Sides::kSameWay;
    Eigen::Vector3d on_a = Eigen::Vector3d::Zero(), on_b = Eigen::Vector3d::Zero();  ///< its ends, world
};

/// The same for (b, a), but for on_a and on_b. Planes that are not finite have no distance, and an angle that
/// is not a number.
PlaneRelation relation(const MapPlane& a, const MapPlane& b);

/// A measure of a room, as a tape has it.
struct RoomSpan {
    enum class Kind {
        kFloorToCeiling,
        kWallToWall,     ///< two walls that face each other
        kWallThickness,  ///< two walls back to back, at most 1 m apart
    };
    Kind kind = Kind::kWallToWall;
    int a = -1, b = -1;      ///< ids; the floor first, else the lower id
    PlaneRelation relation;  ///< with a distance
};

/// "floor to ceiling", "wall to wall" or "wall thickness".
const char* kind_name(RoomSpan::Kind kind);

/// What can be measured across the rooms of a map: pairs that lie opposite by 0.1 square metres or more, with
/// no third plane of their kind (walls; floors and ceilings) parallel between them on more than a quarter of
/// that. By kind and ids. By the labels: where up is not known, there are none.
std::vector<RoomSpan> room_spans(const PlaneMap& map);

}  // namespace planemap::map
