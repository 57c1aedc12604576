// SPDX-License-Identifier: BSD-3-Clause
// What the planes are: floor, ceiling, walls, and other level surfaces.
#pragma once

#include <span>

#include "core/geometry/pose.hpp"
#include "core/plane_map.hpp"
#include "map/gravity.hpp"

namespace planemap::map {

struct LabelRules {
    GravityRules gravity;  ///< its tolerance is also that of level and upright planes here

    double same_height_m = 0.1;  ///< pieces of one floor, or of one ceiling, differ by less in height

    double floor_area_m2 = 2;         ///< smaller level surfaces may be tables,
    double high_floor_area_m2 = 0.5;  ///< but from this up they are floor
    double above_tables_m = 1.1;      ///< when most cameras were this far above them
    double beyond_area = 0.25;        ///< largest area below a floor (above a ceiling), as a share of its own
    double storey_m = 2.0;            ///< smallest height between two floors,
    double standing_m = 2.5;          ///< the upper of which has cameras at most this far above it,
    double standing_share = 0.1;      ///< at least this share of them

    double ceiling_area_m2 = 1;     ///< smaller ones may be shelves and lamps
    double ceiling_height_m = 1.8;  ///< a ceiling is this far above the floor

    double wall_area_m2 = 0.5;      ///< smaller upright planes are no walls; larger ones are if they
    double wall_height_m = 1.2;     ///< are this tall,
    double wall_top_m = 1.8;        ///< or reach this far above the floor,
    double large_wall_area_m2 = 3;  ///< or are this large
};

/// Sets map.up and the label of every plane, from the planes and the poses of the keyframes.
///
/// - floor: level, facing up, below the cameras, large, with little below it; all pieces at its height. A
///   floor of another storey lies at least storey_m higher and cameras stood on it. Steps, landings and
///   platforms are horizontal surfaces.
/// - ceiling: for each storey, the largest level surface facing down that is high above its floor (or, if no
///   floor is seen, above the cameras), with little above it; all pieces at its height or higher.
/// - wall: upright and tall, high or large, so also doors, tall cupboards and partitions.
/// - horizontal: other level surfaces: tables, seats, shelves, steps, and what is level and faces down.
/// - other: what is oblique, and small upright faces such as the sides of a cabinet.
/// - unknown: every plane if up is not known (map.up is zero then), and planes that are not finite.
void label_planes(PlaneMap& map, std::span<const Pose> world_from_camera, const LabelRules& rules = {});

}  // namespace planemap::map
