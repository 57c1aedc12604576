// SPDX-License-Identifier: BSD-3-Clause
// Worlds that lack one thing.
#include <cmath>
#include <numbers>

#include "simulator/looks.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

constexpr double kHallX = 14, kHallY = 5, kHallZ = 3;  // the hall is [0, x] x [0, y] x [0, z]
constexpr double kBareTo = 10;                         // the north wall is bare from 4 m to here, along x

/// Along the north wall at 1.3 m, looking straight at it, and back.
std::vector<Waypoint> wall_tour() {
    constexpr int kSteps = 16;
    constexpr double kStart = 2, kEnd = kHallX - 2, kAway = 1.3;
    std::vector<Waypoint> tour;
    for (int i = 0; i < 2 * kSteps; ++i) {
        const double share = 1 - std::abs(1 - i / static_cast<double>(kSteps));
        const double x = kStart + share * (kEnd - kStart);
        tour.push_back({{x, kHallY - kAway, 1.45}, {x + 0.1 * std::sin(i), kHallY, 1.4}});
    }
    return tour;
}

/// A box of the given half sizes anywhere, any way up, that shares the world's textures.
void add_loose_box(World& world, const Pose& world_from_box, const Vector3d& half, std::uint64_t random) {
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, across = (axis + 1) % 3, along = (axis + 2) % 3;
        const double sign = face % 2 == 0 ? 1 : -1;
        const Vector3d normal = sign * world_from_box.linear().col(axis);
        Rectangle side;
        side.surface = static_cast<int>(world.surfaces.size());
        side.texture =
            static_cast<int>(mix(random, static_cast<std::uint64_t>(face)) % world.textures.size());
        side.centre = world_from_box.translation() + half[axis] * normal;
        side.half_v = half[along] * world_from_box.linear().col(along);
        side.half_u = half[across] * normal.cross(side.half_v.normalized());
        world.rectangles.push_back(side);
        world.surfaces.push_back(
            {"piece " + std::to_string(world.surfaces.size()), {normal, -normal.dot(side.centre)}});
    }
}

/// Around the middle, looking out, with a step to each side.
std::vector<Waypoint> clutter_tour() {
    constexpr int kSteps = 24;
    constexpr double kRadius = 0.45;
    std::vector<Waypoint> tour;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSteps, sway = 0.25 * std::sin(3 * angle);
        const Vector3d out(std::cos(angle), std::sin(angle), 0);
        tour.push_back({kRadius * out + (1.4 + 0.5 * sway) * kUp, 3 * out + (1.4 + sway) * kUp});
    }
    return tour;
}

}  // namespace

World make_wall(std::uint64_t seed, double texel_scale) {
    WorldBuilder hall("wall", seed, texel_scale);
    hall.add_panel("floor", {0, kHallY, 0}, kEast, kSouth, kHallX, kHallY, kFloorTiles);
    hall.add_panel("ceiling", {0, 0, kHallZ}, kEast, kNorth, kHallX, kHallY, kCeilingBoards);
    hall.add_panel("north wall", {0, kHallY, kHallZ}, kEast, kDown, kHallX, kHallZ, kWhite);
    for (const double left : {0.6, 1.6, 2.7, kBareTo + 0.4, kBareTo + 1.5, kBareTo + 2.6})
        hall.add_picture(left, 1.0, 0.7, 1.0, kPoster);
    hall.add_box("west cupboard", {{2.3, kHallY - 0.3, 0}, kEast}, {0.35, 0.3, 1.9}, kBeech, kBeech,
                 {.back = true, .bottom = true});
    hall.add_box("east cupboard", {{kBareTo + 1.15, kHallY - 0.3, 0}, kEast}, {0.3, 0.3, 1.7}, kBeech, kBooks,
                 {.back = true, .bottom = true});
    hall.add_panel("south wall", {kHallX, 0, kHallZ}, kWest, kDown, kHallX, kHallZ, kYellow);
    hall.add_panel("west wall", {0, 0, kHallZ}, kNorth, kDown, kHallY, kHallZ, kBlue);
    hall.add_panel("east wall", {kHallX, kHallY, kHallZ}, kSouth, kDown, kHallY, kHallZ, kBlue);
    World& world = hall.world();
    world.lamps = {{{2.5, 2.5, 2.8}, 1.1}, {{7, 2.5, 2.8}, 1.1}, {{11.5, 2.5, 2.8}, 1.1}};
    world.tour = wall_tour();
    world.free_from = {0.8, 0.8, 0.4};
    world.free_to = {kHallX - 0.8, kHallY - 0.8, 2.4};
    return std::move(world);
}

World make_clutter(std::uint64_t seed, double texel_scale) {
    constexpr std::uint64_t kPieces = 4500;
    constexpr double kNearest = 1.4, kFarthest = 3.2;  // from the middle
    constexpr Look kLooks[] = {kPoster, kBooks, kOak, {Pattern::kCarpet, {0.4f, 0.5f, 0.3f}},
                               kBeech,  kScreen};
    WorldBuilder clutter("clutter", seed, texel_scale);
    World& world = clutter.world();
    for (std::uint64_t i = 0; i < 24; ++i)
        world.textures.push_back(std::make_shared<const Texture>(
            make_texture(kLooks[i % 6], 0.12, 0.12, mix(seed, 59, i), texel_scale)));
    for (std::uint64_t i = 0; i < kPieces; ++i) {
        const auto roll = [&](std::uint64_t k, double low, double high) {
            return uniform(mix(seed, 61, i, k), low, high);
        };
        const double angle = roll(0, 0, 2 * std::numbers::pi), elevation = roll(1, -0.9, 0.9);
        const Vector3d out(std::cos(elevation) * std::cos(angle), std::cos(elevation) * std::sin(angle),
                           std::sin(elevation));
        Twist twist;
        twist << roll(2, kNearest, kFarthest) * out + 1.4 * kUp, roll(3, -3, 3), roll(4, -3, 3),
            roll(5, -3, 3);
        add_loose_box(world, pose_from_twist(twist), {roll(6, 0.02, 0.06), roll(7, 0.02, 0.06), 0.04},
                      mix(seed, 67, i));
    }
    world.lamps = {{{0, 0, 2.2}, 1.6}};
    world.tour = clutter_tour();
    world.free_from = {-0.5, -0.5, 0.9};
    world.free_to = {0.5, 0.5, 1.9};
    return std::move(world);
}

}  // namespace planemap::simulator
