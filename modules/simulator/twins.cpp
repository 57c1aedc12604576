// SPDX-License-Identifier: BSD-3-Clause
// Two rooms that nothing tells apart, joined by a corridor.
#include "simulator/looks.hpp"
#include "simulator/office.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

const Vector3d kApart(7.0, 0, 0);  // of the two rooms
constexpr double kTwinFrom = 1.2, kTwinTo = 12.4, kTwinNear = -0.12, kTwinDepth = 1.6, kTwinHeight = 2.5;

void add_long_corridor(WorldBuilder& twins) {
    constexpr double kFar = kTwinNear - kTwinDepth, kLength = kTwinTo - kTwinFrom;
    const double door = kOfficeDoorFrom - kTwinFrom, door_width = kOfficeDoorTo - kOfficeDoorFrom;
    const Hole doors[] = {
        {door, kTwinHeight - kOfficeDoorZ, door + door_width, kTwinHeight},
        {door + kApart.x(), kTwinHeight - kOfficeDoorZ, door + kApart.x() + door_width, kTwinHeight}};
    twins.add_panel("floor", {kTwinFrom, kTwinNear, 0}, kEast, kSouth, kLength, kTwinDepth, kFloorTiles);
    for (const double from : {kOfficeDoorFrom, kOfficeDoorFrom + kApart.x()})
        twins.add_panel("floor", {from, 0, 0}, kEast, kSouth, door_width, -kTwinNear, kOak);
    twins.add_panel("corridor ceiling", {kTwinFrom, kFar, kTwinHeight}, kEast, kNorth, kLength, kTwinDepth,
                    kCeilingBoards);
    twins.add_panel("corridor north wall", {kTwinFrom, kTwinNear, kTwinHeight}, kEast, kDown, kLength,
                    kTwinHeight, kWhite, doors);
    for (const double left : {0.4, 1.2, 3.2, 4.4, 5.3, 6.6, 7.9, 10.1})
        twins.add_picture(left, 0.7, 0.5, 0.7, kPoster);
    twins.add_panel("corridor south wall", {kTwinTo, kFar, kTwinHeight}, kWest, kDown, kLength, kTwinHeight,
                    kYellow);
    for (const double left : {0.5, 1.5, 2.9, 3.8, 5.2, 6.4, 7.2, 8.7, 9.9})
        twins.add_picture(left, 0.65, 0.6, 0.8, kPoster);
    twins.add_panel("corridor west wall", {kTwinFrom, kFar, kTwinHeight}, kNorth, kDown, kTwinDepth,
                    kTwinHeight, kBlue);
    twins.add_picture(0.35, 0.45, 0.9, 2.05, kOak);
    twins.add_panel("corridor east wall", {kTwinTo, kTwinNear, kTwinHeight}, kSouth, kDown, kTwinDepth,
                    kTwinHeight, kWhite);
    twins.add_picture(0.4, 0.6, 0.8, 1.1, kPoster);
}

/// The office's tour from the corridor in, around the room, and out again, in the room that is `shift` away.
void visit_room(const Vector3d& shift, std::vector<Waypoint>& tour) {
    const std::vector<Waypoint> office = office_tour();
    constexpr std::size_t kIn = 19, kOut = 15;  // waypoints from here to the end, and before this one
    const auto add = [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
            tour.push_back({office[i].position + shift, office[i].target + shift});
    };
    add(kIn, office.size());
    add(0, kOut);
}

std::vector<Waypoint> twins_tour() {
    std::vector<Waypoint> tour;
    visit_room(Vector3d::Zero(), tour);
    tour.push_back({{3.60, -0.60, 1.45}, {4.6, -1.8, 1.2}});
    tour.push_back({{3.80, -0.88, 1.45}, {6.0, -1.4, 1.2}});
    for (int i = 0; i < 8; ++i)
        tour.push_back({{4.5 + 0.7 * i, -0.92, 1.45}, {6.7 + 0.7 * i, i % 2 == 0 ? -1.3 : -0.5, 1.15}});
    tour.push_back({{10.2, -0.90, 1.45}, {12.0, -0.5, 1.2}});
    tour.push_back({{10.45, -0.80, 1.45}, {11.3, 0.3, 1.2}});
    visit_room(kApart, tour);
    tour.push_back({{10.5, -0.60, 1.45}, {9.6, -1.8, 1.2}});
    tour.push_back({{10.3, -0.88, 1.45}, {8.2, -1.4, 1.2}});
    for (int i = 0; i < 8; ++i)
        tour.push_back({{9.5 - 0.7 * i, -0.92, 1.45}, {7.3 - 0.7 * i, i % 2 == 0 ? -1.3 : -0.5, 1.15}});
    tour.push_back({{3.80, -0.90, 1.45}, {2.0, -0.5, 1.2}});
    tour.push_back({{3.60, -0.80, 1.45}, {2.8, 0.3, 1.2}});
    return tour;
}

}  // namespace

World make_twins(std::uint64_t seed, double texel_scale) {
    WorldBuilder room("room", seed, texel_scale);
    add_office_room(room);
    WorldBuilder twins("twins", seed + 1, texel_scale);
    twins.add_world(room.world(), Vector3d::Zero(), "west room ");
    twins.add_world(room.world(), kApart, "east room ");
    add_long_corridor(twins);
    World& world = twins.world();
    for (const double x : {3.3, 6.8, 10.3}) world.lamps.push_back({{x, -0.9, 2.3}, 0.8});
    world.tour = twins_tour();
    world.free_from = {1.2, 0.9, 0.4};
    world.free_to = {4.8, 4.2, 2.3};
    return std::move(world);
}

}  // namespace planemap::simulator
