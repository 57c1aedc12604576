// SPDX-License-Identifier: BSD-3-Clause
// Twenty rooms on both sides of a corridor.
#include <cmath>

#include "core/geometry/angle.hpp"
#include "simulator/looks.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

constexpr int kRoomsASide = 10;
constexpr double kPitch = 4.6, kThickness = 0.12;  // from room to room, of walls
constexpr double kRoomWidth = kPitch - kThickness, kCorridor = 2.0, kPassageZ = 2.4;
constexpr double kDoorWidth = 0.95, kRoomDoorZ = 2.05, kLength = kRoomsASide * kPitch;

/// A room in coordinates of one who stands in its door: from the door wall's left end to the right, forward,
/// and up.
struct Room {
    std::string name;
    Vector3d origin, right, forward;
    double depth = 0, height = 0, door = 0;  ///< door: from the left end to its left side
    std::uint64_t seed = 0;

    Vector3d at(double x, double y, double z) const { return origin + x * right + y * forward + z * kUp; }
    double roll(std::uint64_t k, double low, double high) const { return uniform(mix(seed, k), low, high); }
    /// Metres along the corridor to the middle of its door.
    double door_x() const { return at(door + 0.5 * kDoorWidth, 0, 0).x(); }
};

/// In the order in which they are entered: eastwards on the north side, and back on the south side.
std::vector<Room> rooms_of(std::uint64_t seed) {
    // Neighbours differ by more than any map would take for one plane.
    constexpr double kDepths[] = {3.6, 4.0, 4.4}, kHeights[] = {2.5, 2.65, 2.8};
    std::vector<Room> rooms;
    for (int i = 0; i < 2 * kRoomsASide; ++i) {
        const bool north = i < kRoomsASide;
        const int column = north ? i : 2 * kRoomsASide - 1 - i;
        const double west = column * kPitch + 0.5 * kThickness;
        Room room;
        room.name = "room " + std::to_string(i + 1) + " ";
        room.seed = mix(seed, 97, i);
        room.right = north ? kEast : kWest;
        room.forward = north ? kNorth : kSouth;
        room.origin =
            north ? Vector3d(west, kCorridor + kThickness, 0) : Vector3d(west + kRoomWidth, -kThickness, 0);
        room.depth = kDepths[(i + i / 3) % 3];
        room.height = kHeights[(2 * i + i / 4) % 3];
        room.door = room.roll(1, 1.3, kRoomWidth - kDoorWidth - 1.3);
        rooms.push_back(room);
    }
    return rooms;
}

Look wall_look(const Room& room, std::uint64_t k) {
    constexpr Look kLooks[] = {kWhite, kYellow, kBlue, {Pattern::kBrick, {0.66f, 0.36f, 0.28f}}};
    return kLooks[mix(room.seed, k) % 4];
}

/// Two or three posters on the wall that was added last, where nothing stands before it.
void hang_posters(WorldBuilder& builder, const Room& room, double width, std::uint64_t k) {
    double left = room.roll(k, 0.2, 0.6);
    for (std::uint64_t i = 0; i < 3 && left + 0.7 < width; ++i) {
        const double size = room.roll(k + 10 * i + 1, 0.4, 0.7);
        builder.add_picture(left, room.roll(k + 10 * i + 2, 0.4, 0.8), size,
                            room.roll(k + 10 * i + 3, 0.4, 0.7), kPoster);
        left += size + room.roll(k + 10 * i + 4, 0.3, 0.9);
    }
}

void add_shell(WorldBuilder& builder, const Room& room) {
    const auto& [name, origin, right, forward, depth, height, door, seed] = room;
    const double door_end = door + kDoorWidth;
    builder.add_panel("floor", room.at(0, depth, 0), right, -forward, kRoomWidth, depth, kFloorTiles);
    builder.add_panel("floor", room.at(door, 0, 0), right, -forward, kDoorWidth, kThickness, kOak);
    builder.add_panel(name + "ceiling", room.at(0, 0, height), right, forward, kRoomWidth, depth,
                      kCeilingBoards);
    builder.add_panel(name + "back wall", room.at(0, depth, height), right, kDown, kRoomWidth, height,
                      wall_look(room, 2));
    hang_posters(builder, room, kRoomWidth, 100);
    builder.add_panel(name + "left wall", room.at(0, 0, height), forward, kDown, depth, height,
                      wall_look(room, 3));
    hang_posters(builder, room, depth, 200);
    builder.add_panel(name + "right wall", room.at(kRoomWidth, depth, height), -forward, kDown, depth, height,
                      wall_look(room, 4));
    hang_posters(builder, room, depth, 300);
    const Hole hole{kRoomWidth - door_end, height - kRoomDoorZ, kRoomWidth - door, height};
    builder.add_panel(name + "door wall", room.at(kRoomWidth, 0, height), -right, kDown, kRoomWidth, height,
                      kWhite, {&hole, 1});
    builder.add_panel(name + "left jamb", room.at(door, -kThickness, kRoomDoorZ), forward, kDown, kThickness,
                      kRoomDoorZ, kOak);
    builder.add_panel(name + "right jamb", room.at(door_end, 0, kRoomDoorZ), -forward, kDown, kThickness,
                      kRoomDoorZ, kOak);
    builder.add_panel(name + "lintel", room.at(door, -kThickness, kRoomDoorZ), right, forward, kDoorWidth,
                      kThickness, kOak);
    const double opened = radians(100);
    builder.add_box(name + "door",
                    {room.at(door, 0.02, 0.01), std::cos(opened) * right + std::sin(opened) * forward},
                    {kDoorWidth, 0.04, kRoomDoorZ - 0.02}, kBeech, kBeech, {});
    builder.world().lamps.push_back({room.at(0.5 * kRoomWidth, 0.5 * depth, height - 0.2), 1.1});
}

/// A cupboard at the back wall, a table with a carton at one side, a low shelf at the other.
void add_furniture(WorldBuilder& builder, const Room& room) {
    const double width = room.roll(11, 0.7, 1.2), left = room.roll(12, 0.3, kRoomWidth - 0.3 - width);
    const Look& cupboard = mix(room.seed, 13) % 2 == 0 ? kBeech : kGrey;
    builder.add_box(room.name + "cupboard", {room.at(left, room.depth - 0.42, 0), room.right},
                    {width, 0.42, room.roll(14, 1.0, 1.95)}, cupboard,
                    mix(room.seed, 15) % 2 == 0 ? kBooks : cupboard, {.back = true, .bottom = true});
    const bool table_left = mix(room.seed, 16) % 2 == 0;
    // A piece at a side wall, as seen from the middle: its front edge runs forward on the left, back on the
    // right.
    const auto at_side = [&](bool is_left, double from, double length, double reach, double z) {
        return is_left ? WorldBuilder::Place{room.at(reach, from, z), room.forward}
                       : WorldBuilder::Place{room.at(kRoomWidth - reach, from + length, z), -room.forward};
    };
    const double from = room.roll(17, 1.1, 1.5), top = room.roll(18, 0.70, 0.78);
    builder.add_box(room.name + "table", at_side(table_left, from, 1.4, 0.7, top - 0.03), {1.4, 0.7, 0.03},
                    kOak, kOak, {});
    builder.add_box(room.name + "drawers", at_side(table_left, from, 0.45, 0.65, 0), {0.45, 0.6, top - 0.03},
                    kGrey, kGrey, {.bottom = true, .top = true});
    builder.add_box(room.name + "carton", at_side(table_left, from + 0.8, 0.4, 0.5, top),
                    {0.4, 0.3, room.roll(19, 0.15, 0.4)}, kBeech, kPoster, {.bottom = true});
    builder.add_box(room.name + "shelf", at_side(!table_left, room.roll(20, 1.1, 1.6), 1.1, 0.34, 0),
                    {1.1, 0.34, room.roll(21, 0.5, 1.1)}, kBeech, kBooks, {.back = true, .bottom = true});
}

void add_corridor(WorldBuilder& builder, const std::vector<Room>& rooms) {
    std::vector<Hole> north, south;
    for (const Room& room : rooms) {
        const double from = room.door_x() - 0.5 * kDoorWidth, top = kPassageZ - kRoomDoorZ;
        if (room.right.x() > 0) {
            north.push_back({from, top, from + kDoorWidth, kPassageZ});
        } else {
            south.push_back({kLength - from - kDoorWidth, top, kLength - from, kPassageZ});
        }
    }
    builder.add_panel("floor", {0, kCorridor, 0}, kEast, kSouth, kLength, kCorridor, kFloorTiles);
    builder.add_panel("corridor ceiling", {0, 0, kPassageZ}, kEast, kNorth, kLength, kCorridor,
                      kCeilingBoards);
    const auto decorate = [&](const std::vector<Hole>& doors, std::uint64_t k) {
        for (std::size_t i = 0; i < doors.size(); ++i) {
            const double size = rooms[i].roll(k, 0.5, 0.8);
            builder.add_picture(doors[i].right + rooms[i].roll(k + 1, 0.2, 0.4), 0.5, size, 0.7, kPoster);
        }
    };
    builder.add_panel("corridor north wall", {0, kCorridor, kPassageZ}, kEast, kDown, kLength, kPassageZ,
                      kWhite, north);
    decorate(north, 30);
    builder.add_panel("corridor south wall", {kLength, 0, kPassageZ}, kWest, kDown, kLength, kPassageZ,
                      kYellow, south);
    decorate(south, 40);
    builder.add_panel("corridor west wall", {0, 0, kPassageZ}, kNorth, kDown, kCorridor, kPassageZ, kBlue);
    builder.add_picture(0.4, 0.5, 0.8, 1.1, kPoster);
    builder.add_panel("corridor east wall", {kLength, kCorridor, kPassageZ}, kSouth, kDown, kCorridor,
                      kPassageZ, kBlue);
    builder.add_picture(0.6, 0.5, 0.8, 1.1, kPoster);
    for (int i = 0; i < kRoomsASide; i += 2)
        builder.world().lamps.push_back({{(i + 1) * kPitch, 0.5 * kCorridor, 2.2}, 0.8});
}

/// Through the door, a look to the right, to the left and at the door wall, and out.
void visit(const Room& room, std::vector<Waypoint>& tour) {
    const double door = room.door + 0.5 * kDoorWidth, middle = 0.5 * (door + 0.5 * kRoomWidth);
    const auto add = [&](double x, double y, double to_x, double to_y, double to_z) {
        tour.push_back({room.at(x, y, 1.45), room.at(to_x, to_y, to_z)});
    };
    const double aisle = -kThickness - 0.5 * kCorridor;
    add(door, aisle + 0.2, door, 1.5, 1.2);
    for (const double y : {-0.6, -0.06, 0.5}) add(door, y, door, y + 2.2, 1.1);
    const double y = 0.4 * room.depth;
    add(0.5 * (door + middle), 0.5 * (y + 0.5), middle, room.depth, 1.0);
    for (const double degrees : {15., 50., 85., 110., 85., 50., 15., -20., -55., -90., -125., -160.}) {
        const double angle = radians(degrees);
        add(middle, y, middle + 2 * std::sin(angle), y + 2 * std::cos(angle), 0.95);
    }
    for (const double out : {0.5, -0.06, -0.6}) add(door, out, door, out - 2.2, 1.1);
}

std::vector<Waypoint> rooms_tour(const std::vector<Room>& rooms) {
    std::vector<Waypoint> tour;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        visit(rooms[i], tour);
        const double from = rooms[i].door_x(), to = rooms[(i + 1) % rooms.size()].door_x();
        const double way = to > from ? 1 : -1, length = std::abs(to - from);
        for (double x = 0.4; x < length - 0.6; x += 0.8) {
            const Vector3d here(from + way * x, 0.5 * kCorridor, 1.45);
            tour.push_back({here, here + way * 2.2 * kEast + Vector3d(0, 0.4 * std::sin(2 * x), -0.25)});
        }
    }
    return tour;
}

}  // namespace

World make_rooms(std::uint64_t seed, double texel_scale) {
    WorldBuilder builder("rooms", seed, texel_scale);
    const std::vector<Room> rooms = rooms_of(seed);
    for (const Room& room : rooms) {
        add_shell(builder, room);
        add_furniture(builder, room);
    }
    add_corridor(builder, rooms);
    World& world = builder.world();
    world.tour = rooms_tour(rooms);
    world.whole_tour = true;
    world.free_from = {0.6, 0.5, 0.4};
    world.free_to = {kLength - 0.6, kCorridor - 0.5, 2.2};
    return std::move(world);
}

}  // namespace planemap::simulator
