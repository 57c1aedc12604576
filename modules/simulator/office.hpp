// SPDX-License-Identifier: BSD-3-Clause
// What other worlds take from the office.
#pragma once

#include "core/geometry/angle.hpp"
#include "simulator/world.hpp"

namespace planemap::simulator {

/// The door in the office's south wall (y = 0): from, to along x, and its height. Metres.
inline constexpr double kOfficeDoorFrom = 3.1, kOfficeDoorTo = 4.0, kOfficeDoorZ = 2.05;

/// Where its leaf turns, on the floor, and how far it stands open. World frame.
inline const Eigen::Vector3d kOfficeHinge{kOfficeDoorFrom, 0.02, 0};
inline constexpr double kOfficeDoorOpened = radians(110);

/// The leaf of the door, opened by an angle from where it closes the doorway; it opens into the room.
void add_office_door(WorldBuilder& office, double opened);

/// The office as a whole, with the corridor and its lamps, without a walk; its door stands open or is left
/// out.
void add_office(WorldBuilder& office, bool with_door);

/// The office's room with all that stands in it, its doorway and its lamps, without the corridor.
void add_office_room(WorldBuilder& office);

/// Around the room looking out, through the door, about the corridor and back to the start.
std::vector<Waypoint> office_tour();

}  // namespace planemap::simulator
