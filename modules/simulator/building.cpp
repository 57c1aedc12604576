// SPDX-License-Identifier: BSD-3-Clause
// A corridor around a block of rooms that nobody enters: one round is 100 m.
#include <cmath>

#include "simulator/looks.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

constexpr double kHallWidth = 2.4, kHallHeight = 2.6;  // of the corridor
constexpr double kLengthX = 34.4, kLengthY = 20.4;     // of the outer walls
constexpr double kMiddleX = kLengthX - kHallWidth,
                 kMiddleY = kLengthY - kHallWidth;  // of the path: 2 (32 + 18) m
constexpr double kSegment = 6;                      // a wall's look changes about so often

/// One of the four legs, in the order that they are walked: counter-clockwise from above.
struct Leg {
    std::string name;
    Vector3d corner, along;  ///< outer corner where it begins, direction of the walk
    double length = 0;       ///< of the outer wall
    Vector3d left() const { return kUp.cross(along); }  ///< from the outer wall to the inner one
};

std::vector<Leg> legs() {
    return {{"south", {0, 0, 0}, kEast, kLengthX},
            {"east", {kLengthX, 0, 0}, kNorth, kLengthY},
            {"north", {kLengthX, kLengthY, 0}, kWest, kLengthX},
            {"west", {0, kLengthY, 0}, kSouth, kLengthY}};
}

/// Numbers of one world, in the order that they are asked for.
class LegDice {
  public:
    explicit LegDice(std::uint64_t seed) : seed_(mix(seed, 53)) {}
    double roll(double low, double high) { return uniform(mix(seed_, count_++), low, high); }
    std::size_t pick(std::size_t count) { return mix(seed_, count_++) % count; }

  private:
    std::uint64_t seed_, count_ = 0;
};

/// A piece of a leg's outer or inner wall from `from` to `to` along the leg, with a door or without, and
/// posters.
void add_wall_segment(WorldBuilder& building, const Leg& leg, bool outer, double from, double to,
                      LegDice& dice) {
    constexpr Look kLooks[] = {kWhite, kYellow, kBlue, {Pattern::kBrick, {0.66f, 0.36f, 0.28f}}};
    const double width = to - from;
    const Vector3d end = leg.corner + kHallHeight * kUp + (outer ? to : from) * leg.along;
    building.add_panel(leg.name + (outer ? " outer wall" : " inner wall"),
                       outer ? end : end + kHallWidth * leg.left(), outer ? Vector3d(-leg.along) : leg.along,
                       kDown, width, kHallHeight, kLooks[dice.pick(4)]);
    double left = dice.roll(0.2, 0.8);
    if (width > 3 && dice.pick(2) == 0) {
        building.add_picture(left, kHallHeight - 2.05, 0.9, 2.05, dice.pick(2) == 0 ? kOak : kGrey);
        left += 1.0 + dice.roll(0.2, 0.8);
    }
    while (left + 0.9 < width) {
        const double size = dice.roll(0.4, 0.8);
        building.add_picture(left, dice.roll(0.5, 0.9), size, dice.roll(0.5, 0.9), kPoster);
        left += size + dice.roll(0.4, 1.5);
    }
}

void add_walls(WorldBuilder& building, const Leg& leg, LegDice& dice) {
    for (const bool outer : {true, false}) {
        const double from = outer ? 0 : kHallWidth, length = leg.length - 2 * from;
        const int count = static_cast<int>(std::ceil(length / kSegment));
        for (int i = 0; i < count; ++i) {
            add_wall_segment(building, leg, outer, from + length * i / count, from + length * (i + 1) / count,
                             dice);
        }
    }
}

/// Cupboards and shelves along both walls, so that depth alone shows how far one has walked.
void add_furniture(WorldBuilder& building, const Leg& leg, LegDice& dice) {
    constexpr double kDepth = 0.35;
    int count = 0;
    for (double at = kHallWidth + dice.roll(0, 2); at < leg.length - kHallWidth - 1.2;
         at += dice.roll(2.5, 6.0)) {
        const bool outer = dice.pick(2) == 0;
        const double width = dice.roll(0.5, 1.1), height = dice.roll(0.6, 1.9);
        const Vector3d front = leg.corner + (outer ? kDepth : kHallWidth - kDepth) * leg.left();
        const WorldBuilder::Place place{front + (outer ? at + width : at) * leg.along,
                                        outer ? Vector3d(-leg.along) : leg.along};
        const Look& look = dice.pick(2) == 0 ? kBeech : kGrey;
        building.add_box(leg.name + " cupboard " + std::to_string(++count), place, {width, kDepth, height},
                         look, dice.pick(3) == 0 ? kBooks : look, {.back = true, .bottom = true});
    }
}

/// Floor and ceiling of a leg; the corners belong to the long legs.
void add_floor(WorldBuilder& building, const Leg& leg) {
    const bool level = std::abs(leg.along.x()) > 0.5;
    const double skip = level ? 0 : kHallWidth, length = leg.length - 2 * skip;
    const int count = static_cast<int>(std::ceil(length / kSegment));
    for (int i = 0; i < count; ++i) {
        const Vector3d a = leg.corner + (skip + length * i / count) * leg.along;
        const Vector3d b =
            leg.corner + (skip + length * (i + 1) / count) * leg.along + kHallWidth * leg.left();
        const Vector3d low = a.cwiseMin(b), size = (a - b).cwiseAbs();
        building.add_panel("floor", low + size.y() * kNorth, kEast, kSouth, size.x(), size.y(), kFloorTiles);
        building.add_panel("ceiling", low + kHallHeight * kUp, kEast, kNorth, size.x(), size.y(),
                           kCeilingBoards);
    }
}

/// The point of the path after so many metres.
Vector3d on_path(double metres) {
    const double sides[] = {kMiddleX, kMiddleY, kMiddleX, kMiddleY};
    const std::vector<Leg> all = legs();
    metres = std::fmod(metres, 2 * (kMiddleX + kMiddleY));
    std::size_t i = 0;
    for (; i < 3 && metres > sides[i]; ++i) metres -= sides[i];
    const Vector3d start = all[i].corner + 0.5 * kHallWidth * (all[i].along + all[i].left());
    return start + metres * all[i].along;
}

/// Along the path, looking ahead and to both sides in turn, as one does who looks for a door.
std::vector<Waypoint> building_tour() {
    constexpr int kSteps = 80;
    constexpr double kAhead = 2.2, kSway = 0.8, kSwayPeriod = 10;  // steps
    std::vector<Waypoint> tour;
    for (int i = 0; i < kSteps; ++i) {
        const double step = 2 * (kMiddleX + kMiddleY) / kSteps;
        const Vector3d here = on_path(i * step), ahead = on_path(i * step + kAhead);
        const Vector3d side = kUp.cross((ahead - here).normalized());
        const double sway = kSway * std::sin(2 * 3.14159265358979 * i / kSwayPeriod);
        tour.push_back({here + 1.5 * kUp, ahead + sway * side + 1.15 * kUp});
    }
    return tour;
}

}  // namespace

World make_building(std::uint64_t seed, double texel_scale) {
    WorldBuilder building("building", seed, texel_scale);
    LegDice dice(seed);
    for (const Leg& leg : legs()) {
        add_walls(building, leg, dice);
        add_furniture(building, leg, dice);
        add_floor(building, leg);
    }
    World& world = building.world();
    constexpr int kLamps = 20;
    for (int i = 0; i < kLamps; ++i)
        world.lamps.push_back({on_path(i * 2 * (kMiddleX + kMiddleY) / kLamps) + 2.4 * kUp, 0.8});
    world.tour = building_tour();
    world.free_from = {0.6, 0.6, 0.4};
    world.free_to = {kLengthX - 0.6, kHallWidth - 0.6, 2.2};
    return std::move(world);
}

}  // namespace planemap::simulator
