// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/office.hpp"

#include <cmath>

#include "core/geometry/angle.hpp"
#include "simulator/looks.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

constexpr double kRoomX = 6.0, kRoomY = 5.0, kRoomZ = 2.7;  // the room is [0, x] x [0, y] x [0, z]
constexpr double kWallThickness = 0.12;
constexpr double kDoorFrom = kOfficeDoorFrom, kDoorTo = kOfficeDoorTo, kDoorZ = kOfficeDoorZ;
constexpr double kCorridorFrom = 1.2, kCorridorTo = 5.4, kCorridorDepth = 1.6, kCorridorZ = 2.5;

/// The walls of the room, with a corner cut off by a wall at 56 deg to the north wall.
void add_room(WorldBuilder& office) {
    constexpr double kCut = 1.2;  // of the north wall
    const double cut_east = kCut * std::tan(radians(56));
    const Vector3d corner(kRoomX - kCut, kRoomY, kRoomZ);
    const Vector3d end(kRoomX, kRoomY - cut_east, kRoomZ);

    office.add_panel("floor", {0, kRoomY, 0}, kEast, kSouth, kRoomX, kRoomY,
                     {Pattern::kPlanks, {0.62f, 0.45f, 0.30f}});
    office.add_picture(2.0, 1.6, 1.9, 1.5, {Pattern::kCarpet, {0.45f, 0.30f, 0.30f}});
    office.add_panel("ceiling", {0, 0, kRoomZ}, kEast, kNorth, kRoomX, kRoomY,
                     {Pattern::kPanels, {0.88f, 0.88f, 0.86f}});

    office.add_panel("north wall", {0, kRoomY, kRoomZ}, kEast, kDown, kRoomX - kCut, kRoomZ, kWhite);
    office.add_picture(1.75, 0.65, 0.6, 0.8, kPoster);
    office.add_picture(3.2, 0.45, 0.9, 0.6, kPoster);
    office.add_panel("slanted wall", corner, (end - corner).normalized(), kDown, (end - corner).norm(),
                     kRoomZ, kYellow);
    office.add_picture(0.7, 0.8, 0.7, 1.0, kPoster);
    office.add_panel("west wall", {0, 0, kRoomZ}, kNorth, kDown, kRoomY, kRoomZ, kBlue);
    office.add_picture(1.2, 0.55, 0.5, 0.7, kPoster);
    office.add_picture(2.3, 0.5, 1.0, 0.7, kPoster);
    office.add_picture(3.6, 0.75, 0.42, 0.6, kPoster);

    const Hole door{kRoomX - kDoorTo, kRoomZ - kDoorZ, kRoomX - kDoorFrom, kRoomZ};
    office.add_panel("south wall", {kRoomX, 0, kRoomZ}, kWest, kDown, kRoomX, kRoomZ,
                     {Pattern::kBrick, {0.66f, 0.36f, 0.28f}}, {&door, 1});
    office.add_picture(0.5, 0.6, 0.8, 0.6, kPoster);
}

/// The east wall with a window in a niche, and a radiator below it.
void add_window(WorldBuilder& office) {
    const double north_end = kRoomY - 1.2 * std::tan(radians(56));
    constexpr double kFrom = 1.2, kTo = 2.9, kLow = 0.95, kHigh = 2.15, kDepth = 0.18;
    constexpr double kWidth = kTo - kFrom, kHeight = kHigh - kLow, kPane = kRoomX + kDepth;
    const Hole window{north_end - kTo, kRoomZ - kHigh, north_end - kFrom, kRoomZ - kLow};
    office.add_panel("east wall", {kRoomX, north_end, kRoomZ}, kSouth, kDown, north_end, kRoomZ, kWhite,
                     {&window, 1});
    office.add_panel("window", {kPane, kTo, kHigh}, kSouth, kDown, kWidth, kHeight, {Pattern::kOutside, {}});
    office.add_panel("window sill", {kPane, kTo, kLow}, kSouth, kWest, kWidth, kDepth, kOak);
    office.add_panel("window lintel", {kRoomX, kTo, kHigh}, kSouth, kEast, kWidth, kDepth, kWhite);
    office.add_panel("window left", {kRoomX, kTo, kHigh}, kEast, kDown, kDepth, kHeight, kWhite);
    office.add_panel("window right", {kPane, kFrom, kHigh}, kWest, kDown, kDepth, kHeight, kWhite);
    office.add_box("radiator", {{kRoomX - 0.15, 2.6, 0.12}, kSouth}, {1.1, 0.15, 0.56}, kGrey, kGrey,
                   {.back = true});
}

/// The door's frame.
void add_doorway(WorldBuilder& office) {
    constexpr double kNear = -kWallThickness, kDoorWidth = kDoorTo - kDoorFrom;
    office.add_panel("door jamb west", {kDoorFrom, kNear, kDoorZ}, kNorth, kDown, kWallThickness, kDoorZ,
                     kOak);
    office.add_panel("door jamb east", {kDoorTo, 0, kDoorZ}, kSouth, kDown, kWallThickness, kDoorZ, kOak);
    office.add_panel("door lintel", {kDoorFrom, kNear, kDoorZ}, kEast, kNorth, kDoorWidth, kWallThickness,
                     kOak);
}

/// The corridor behind the door.
void add_corridor(WorldBuilder& office) {
    constexpr double kNear = -kWallThickness, kFar = kNear - kCorridorDepth;
    constexpr double kLength = kCorridorTo - kCorridorFrom, kDoorWidth = kDoorTo - kDoorFrom;
    const Hole door{kDoorFrom - kCorridorFrom, kCorridorZ - kDoorZ, kDoorTo - kCorridorFrom, kCorridorZ};
    office.add_panel("floor", {kCorridorFrom, kNear, 0}, kEast, kSouth, kLength, kCorridorDepth,
                     {Pattern::kTiles, {0.62f, 0.63f, 0.60f}});
    office.add_panel("floor", {kDoorFrom, 0, 0}, kEast, kSouth, kDoorWidth, kWallThickness, kOak);
    office.add_panel("corridor ceiling", {kCorridorFrom, kFar, kCorridorZ}, kEast, kNorth, kLength,
                     kCorridorDepth, {Pattern::kPanels, {0.86f, 0.87f, 0.88f}});
    office.add_panel("corridor north wall", {kCorridorFrom, kNear, kCorridorZ}, kEast, kDown, kLength,
                     kCorridorZ, kWhite, {&door, 1});
    office.add_picture(0.35, 0.75, 0.5, 0.7, kPoster);
    office.add_picture(1.2, 0.65, 0.55, 0.75, kPoster);
    office.add_picture(3.0, 0.8, 0.42, 0.6, kPoster);
    office.add_panel("corridor south wall", {kCorridorTo, kFar, kCorridorZ}, kWest, kDown, kLength,
                     kCorridorZ, kYellow);
    office.add_picture(1.1, 0.65, 0.6, 0.85, kPoster);
    office.add_picture(2.1, 0.6, 0.9, 0.6, kPoster);
    office.add_picture(3.3, 0.75, 0.45, 0.6, kPoster);
    office.add_panel("corridor west wall", {kCorridorFrom, kFar, kCorridorZ}, kNorth, kDown, kCorridorDepth,
                     kCorridorZ, kBlue);
    office.add_picture(0.35, 0.45, 0.9, 2.05, kOak);
    office.add_picture(0.6, 0.9, 0.4, 0.3, kPoster);
    office.add_panel("corridor east wall", {kCorridorTo, kNear, kCorridorZ}, kSouth, kDown, kCorridorDepth,
                     kCorridorZ, kWhite);
    office.add_picture(0.4, 0.6, 0.8, 1.1, kPoster);
}

/// A top with a thickness on two side panels.
void add_table(WorldBuilder& office, const std::string& name, const WorldBuilder::Place& place, double width,
               double depth, double height, const Look& look) {
    constexpr double kTop = 0.03, kSide = 0.03, kInset = 0.06;
    const Vector3d forward = kUp.cross(place.right);
    const WorldBuilder::Size side{kSide, depth - 2 * kInset, height - kTop};
    const Vector3d left = place.front_left + kInset * (place.right + forward);
    const Vector3d right = left + (width - 2 * kInset - kSide) * place.right;
    office.add_box(name, {place.front_left + (height - kTop) * kUp, place.right}, {width, depth, kTop}, look,
                   look, {});
    office.add_box(name + " left leg", {left, place.right}, side, kGrey, kGrey,
                   {.bottom = true, .top = true});
    office.add_box(name + " right leg", {right, place.right}, side, kGrey, kGrey,
                   {.bottom = true, .top = true});
}

/// A screen on a foot, on a table.
void add_monitor(WorldBuilder& office, const std::string& name, const Vector3d& foot, const Vector3d& right) {
    constexpr double kWidth = 0.54, kHeight = 0.33, kDepth = 0.04, kFoot = 0.2;
    const Vector3d forward = kUp.cross(right);
    office.add_box(name + " foot", {foot - 0.5 * kFoot * (right + forward), right}, {kFoot, kFoot, 0.02},
                   kPlastic, kPlastic, {.bottom = true});
    office.add_box(name, {foot - 0.5 * kWidth * right + 0.11 * kUp, right}, {kWidth, kDepth, kHeight},
                   kPlastic, kScreen, {});
}

void add_desk(WorldBuilder& office) {
    add_table(office, "desk", {{0.8, 1.3, 0}, kNorth}, 1.6, 0.8, 0.75, kBeech);
    const double turned = radians(75);
    add_monitor(office, "monitor", {0.32, 1.75, 0.75}, kNorth);
    add_monitor(office, "second monitor", {0.34, 2.42, 0.75}, {std::cos(turned), std::sin(turned), 0});
    office.add_box("keyboard", {{0.72, 1.6, 0.75}, kNorth}, {0.42, 0.14, 0.02}, kPlastic, kPlastic,
                   {.bottom = true});
    office.add_box("paper", {{0.66, 2.55, 0.75}, kNorth}, {0.22, 0.3, 0.07}, kWhite, kPoster,
                   {.bottom = true});
    office.add_box("stool", {{1.35, 1.75, 0}, kNorth}, {0.4, 0.4, 0.46},
                   {Pattern::kCarpet, {0.30f, 0.40f, 0.32f}}, {Pattern::kCarpet, {0.30f, 0.40f, 0.32f}},
                   {.bottom = true});
}

/// A table with a screen that passes through its top: planes that cross.
void add_corner_table(WorldBuilder& office) {
    add_table(office, "corner table", {{4.3, 0.5, 0}, kEast}, 1.4, 0.8, 0.82, kOak);
    office.add_box("privacy screen", {{5.0, 1.2, 0.45}, kSouth}, {0.6, 0.03, 0.85},
                   {Pattern::kCarpet, {0.62f, 0.45f, 0.25f}}, {Pattern::kCarpet, {0.62f, 0.45f, 0.25f}}, {});
    office.add_box("carton", {{4.42, 0.75, 0.82}, kEast}, {0.36, 0.3, 0.24},
                   {Pattern::kPaint, {0.70f, 0.55f, 0.38f}}, kPoster, {.bottom = true});
    office.add_box("row of books", {{5.2, 0.72, 0.82}, kEast}, {0.4, 0.2, 0.27}, kWhite, kBooks,
                   {.bottom = true});
}

void add_cupboards(WorldBuilder& office) {
    office.add_box("tall cupboard", {{0.6, 4.58, 0}, kEast}, {0.9, 0.42, 1.9}, kBeech, kBeech,
                   {.back = true, .bottom = true});
    office.add_picture(0.15, 0.35, 0.3, 0.42, kPoster);
    office.add_picture(0.445, 0.03, 0.01, 1.84, kPlastic);
    office.add_box("low cupboard", {{1.5, 4.50, 0}, kEast}, {1.2, 0.5, 1.12}, kGrey, kGrey,
                   {.back = true, .bottom = true});
    office.add_picture(0.1, 0.12, 0.3, 0.2, kPoster);
    office.add_box("binders", {{1.65, 4.62, 1.12}, kEast}, {0.7, 0.28, 0.32}, kWhite, kBooks,
                   {.bottom = true});
}

void add_shelf(WorldBuilder& office) {
    constexpr double kFrom = 1.2, kTo = 2.2, kDepth = 0.3, kBoard = 0.025, kHeight = 1.8;
    // As seen from the room, looking south, the shelf's left end is at the greater x.
    office.add_box("shelf left side", {{kTo, kDepth, 0}, kWest}, {kBoard, kDepth, kHeight}, kBeech, kBeech,
                   {.back = true, .bottom = true});
    office.add_box("shelf right side", {{kFrom + kBoard, kDepth, 0}, kWest}, {kBoard, kDepth, kHeight},
                   kBeech, kBeech, {.back = true, .bottom = true});
    const double inner = kTo - kFrom - 2 * kBoard;
    for (int i = 0; i < 5; ++i) {
        const double z = 0.06 + 0.42 * i;
        const std::string name = "shelf board " + std::to_string(i + 1);
        office.add_box(name, {{kTo - kBoard, kDepth, z}, kWest}, {inner, kDepth, kBoard}, kBeech, kBeech,
                       {.back = true, .left = true, .right = true});
        if (i == 4) continue;
        const double left = 0.05 + 0.07 * ((i * 5) % 4), width = 0.45 + 0.08 * ((i * 3) % 4);
        office.add_box("books " + std::to_string(i + 1), {{kTo - kBoard - left, 0.24, z + kBoard}, kWest},
                       {width, 0.2, 0.25 + 0.02 * (i % 3)}, kWhite, kBooks, {.bottom = true});
    }
}

/// Two boards that cross, and a drawing board that leans back.
void add_boards(WorldBuilder& office) {
    constexpr double kHeight = 1.5, kThickness = 0.03;
    const Vector3d centre(5.15, 3.2, 0);
    const auto board = [&](const std::string& name, double angle_deg, double length, const Look& front) {
        const double angle = radians(angle_deg);
        const Vector3d along(std::cos(angle), std::sin(angle), 0);
        const Vector3d corner = centre - 0.5 * length * along - 0.5 * kThickness * kUp.cross(along);
        office.add_box(name, {corner, along}, {length, kThickness, kHeight},
                       {Pattern::kCarpet, {0.35f, 0.42f, 0.55f}}, front, {.bottom = true});
    };
    board("display board", -65, 0.9, {Pattern::kCarpet, {0.35f, 0.42f, 0.55f}});
    office.add_picture(0.12, 0.15, 0.3, 0.42, kPoster);
    office.add_picture(0.55, 0.3, 0.28, 0.38, kPoster);
    board("crossing board", 25, 0.7, {Pattern::kCarpet, {0.35f, 0.42f, 0.55f}});

    const double lean = radians(40);
    const Vector3d up(0, std::sin(lean), std::cos(lean));
    office.add_box("drawing board", {{3.1, 4.1, 0.78}, kEast, up}, {1.1, 0.03, 0.85}, kBeech, kBeech, {});
    office.add_picture(0.15, 0.15, 0.6, 0.5, kPoster);
    for (const double x : {3.2, 4.06}) {
        office.add_box(x < 3.5 ? "drawing board left foot" : "drawing board right foot",
                       {{x, 4.25, 0}, kEast}, {0.04, 0.4, 0.9}, kGrey, kGrey, {.bottom = true});
    }
}

void add_furniture(WorldBuilder& office) {
    add_desk(office);
    add_corner_table(office);
    add_cupboards(office);
    add_shelf(office);
    add_boards(office);
}

/// Five places of the room, as the paper's Table 2 has them; the way between any two is free.
std::vector<Waypoint> office_places() {
    return {{{2.00, 2.60, 1.45}, {0.2, 2.3, 1.0}},
            {{2.60, 3.40, 1.48}, {1.5, 5.0, 1.1}},
            {{3.80, 2.95, 1.45}, {5.9, 3.4, 1.1}},
            {{3.75, 1.75, 1.42}, {4.9, 0.2, 1.1}},
            {{2.45, 1.85, 1.45}, {1.5, 0.2, 1.0}}};
}

}  // namespace

void add_office_door(WorldBuilder& office, double opened) {
    const Vector3d along(std::cos(opened), std::sin(opened), 0);
    office.add_box("door", {kOfficeHinge + 0.01 * kUp, along}, {kDoorTo - kDoorFrom, 0.04, kDoorZ - 0.02},
                   kBeech, kBeech, {});
    office.add_picture(0.25, 0.45, 0.4, 0.3, kPoster);
}

void add_office_room(WorldBuilder& office) {
    add_room(office);
    add_window(office);
    add_doorway(office);
    add_office_door(office, kOfficeDoorOpened);
    add_furniture(office);
    office.world().lamps = {{{1.7, 2.5, 2.5}, 1.1}, {{4.3, 2.4, 2.5}, 1.1}};
}

std::vector<Waypoint> office_tour() {
    return {{{2.00, 2.40, 1.45}, {0.2, 2.1, 1.0}},   {{2.00, 2.80, 1.45}, {0.3, 3.2, 1.1}},
            {{2.10, 3.20, 1.50}, {0.6, 4.5, 1.2}},   {{2.50, 3.45, 1.50}, {1.5, 5.0, 1.1}},
            {{2.95, 3.50, 1.45}, {2.7, 5.0, 1.2}},   {{3.40, 3.35, 1.42}, {4.0, 4.9, 1.2}},
            {{3.75, 3.10, 1.42}, {5.2, 4.3, 1.2}},   {{3.95, 2.80, 1.45}, {5.9, 3.2, 1.1}},
            {{4.00, 2.45, 1.50}, {6.0, 2.0, 1.3}},   {{3.95, 2.05, 1.50}, {5.6, 0.9, 1.0}},
            {{3.80, 1.65, 1.45}, {4.8, 0.2, 1.1}},   {{3.65, 1.20, 1.40}, {3.8, -0.6, 1.2}},
            {{3.57, 0.75, 1.40}, {3.55, -1.5, 1.2}}, {{3.55, 0.30, 1.40}, {3.55, -1.9, 1.2}},
            {{3.55, -0.20, 1.40}, {3.3, -1.9, 1.2}}, {{3.52, -0.60, 1.45}, {2.6, -1.8, 1.2}},
            {{3.42, -0.85, 1.45}, {1.4, -1.5, 1.2}}, {{3.44, -0.90, 1.45}, {1.4, -0.6, 1.2}},
            {{3.50, -0.80, 1.45}, {2.6, 0.3, 1.2}},  {{3.55, -0.50, 1.42}, {3.4, 1.2, 1.2}},
            {{3.55, -0.05, 1.42}, {3.5, 2.4, 1.1}},  {{3.53, 0.40, 1.42}, {3.3, 3.6, 1.0}},
            {{3.42, 0.85, 1.45}, {2.9, 4.4, 1.0}},   {{3.15, 1.30, 1.45}, {1.8, 4.0, 1.1}},
            {{2.80, 1.65, 1.45}, {0.8, 2.6, 1.0}},   {{2.52, 1.88, 1.45}, {0.8, 1.0, 1.0}},
            {{2.28, 2.08, 1.45}, {1.2, 0.3, 1.0}},   {{2.10, 2.22, 1.45}, {0.4, 1.2, 1.0}}};
}

void add_office(WorldBuilder& office, bool with_door) {
    add_room(office);
    add_window(office);
    add_corridor(office);
    add_doorway(office);
    if (with_door) add_office_door(office, kOfficeDoorOpened);
    add_furniture(office);
    World& world = office.world();
    world.lamps = {{{1.7, 2.5, 2.5}, 1.1}, {{4.3, 2.4, 2.5}, 1.1}, {{3.3, -0.9, 2.3}, 0.8}};
    world.free_from = {1.2, 0.9, 0.4};
    world.free_to = {4.8, 4.2, 2.3};
}

World make_office(std::uint64_t seed, double texel_scale) {
    WorldBuilder office("office", seed, texel_scale);
    add_office(office, true);
    World& world = office.world();
    world.tour = office_tour();
    world.places = office_places();
    return std::move(world);
}

}  // namespace planemap::simulator
