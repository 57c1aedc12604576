// SPDX-License-Identifier: BSD-3-Clause
// What the planes are: floor, ceiling, walls, and other level and upright surfaces.
#pragma once

#include <span>

#include "core/geometry/pose.hpp"
#include "core/plane_map.hpp"
#include "map/gravity.hpp"

namespace planemap::map {

struct LabelRules {
    GravityRules gravity;  ///< its tolerance is also that of level and upright planes here

    double same_height_m = 0.1;    ///< pieces of one floor, or of one ceiling, differ by less in height,
    double piece_area_m2 = 0.2;    ///< or, if they are smaller than that,
    double scrap_height_m = 0.05;  ///< by less than this: not the lowest shelf

    double floor_area_m2 = 2;         ///< smaller level surfaces may be tables,
    double high_floor_area_m2 = 0.5;  ///< but from this up they are floor
    double above_tables_m = 1.1;      ///< when most cameras were this far above them
    double beyond_area = 0.25;        ///< largest area below a floor (above a ceiling), as a share of its own
    double weakest = 0.1;             ///< support of a floor, as a share of the strongest one's
    double step_m = 0.35;             ///< a floor goes on up or down a step of at most this, a ceiling down;
    double storey_m = 2.0;            ///< smallest height between two floors,
    double standing_m = 2.5;          ///< the upper of which has cameras at most this far above it,
    double standing_share = 0.1;      ///< at least this share of them

    double ceiling_area_m2 = 1;     ///< smaller ones may be shelves and lamps
    double ceiling_height_m = 1.8;  ///< a ceiling is this far above the floor
    double at_ceiling_m = 0.25;     ///< what reaches up to this under it, reaches it

    double wall_area_m2 = 0.5;      ///< smaller upright planes are no walls; larger ones are if they
    double wall_height_m = 1.2;     ///< are this tall,
    double wall_top_m = 1.8;        ///< or reach this far above the floor,
    double large_wall_area_m2 = 3;  ///< or are this large,
    double wall_width_m = 0.5;      ///< and this wide: the side of a cupboard is not
};

/// Sets map.up and the label of every plane, by an up that is known or not, from the planes and the poses of
/// the keyframes. Wherever an area is compared with another one, it counts by how often it was seen
/// (supported_area()): what one look saw does not outweigh what twenty saw.
///
/// - floor: level, facing up, below the cameras, large, with little below it; all pieces at its height, and
///   large surfaces a step above or below it. A floor of another storey lies at least storey_m higher and
///   cameras stood on it. Steps, landings and higher platforms are horizontal surfaces.
/// - ceiling: for each storey, the largest level surface facing down that is high above its floor (or, if no
///   floor is seen, above the cameras), with little above it; all pieces at its height or higher, and large
///   ones a step below it.
/// - wall: an upright plane that bounds the room: it reaches the ceiling; or it is tall, high or large,
///   not narrow, nothing is seen over it (is_seen_over()) and no top goes back from its upper edge
///   (has_top()). Doors, too, and cupboards up to the ceiling.
/// - vertical: other upright planes: faces of furniture.
/// - horizontal: other level surfaces: tables, seats, shelves, steps, and what is level and faces down.
/// - other: what is oblique.
/// - unknown: every plane if up is not known (map.up is zero then), and planes that are not finite.
void label_planes(PlaneMap& map, const Up& up, std::span<const Pose> world_from_camera,
                  const LabelRules& rules = {});

/// The same by find_up(), which it returns.
Up label_planes(PlaneMap& map, std::span<const Pose> world_from_camera, const LabelRules& rules = {});

}  // namespace planemap::map
