// SPDX-License-Identifier: BSD-3-Clause
// What other worlds take from the office.
#pragma once

#include "simulator/world.hpp"

namespace planemap::simulator {

/// The door in the office's south wall (y = 0): from, to along x, and its height. Metres.
inline constexpr double kOfficeDoorFrom = 3.1, kOfficeDoorTo = 4.0, kOfficeDoorZ = 2.05;

/// The office's room with all that stands in it, its doorway and its lamps, without the corridor.
void add_office_room(WorldBuilder& office);

/// Around the room looking out, through the door, about the corridor and back to the start.
std::vector<Waypoint> office_tour();

}  // namespace planemap::simulator
