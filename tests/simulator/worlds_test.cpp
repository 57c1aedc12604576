// SPDX-License-Identifier: BSD-3-Clause
// What holds for every simulated world, and what each one is for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/trajectory.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kCoarse = 8;  // texels

std::vector<World> all_worlds() {
    std::vector<World> worlds;
    for (const auto make :
         {&make_office, &make_building, &make_twins, &make_wall, &make_clutter, &make_glass, &make_appearing,
          &make_vanishing, &make_moved, &make_door, &make_walker, &make_rooms, &make_wallpaper, &make_mural})
        worlds.push_back(make(3, kCoarse));
    return worlds;
}

SimulatedSource small(const std::string& world_and_parameters, const char* more = "") {
    return SimulatedSource(parse_simulator_name("sim:" + world_and_parameters +
                                                "width=160&height=120&noise=0&frames=30" + more));
}

TEST(Worlds, RectanglesLieOnTheirSurfaces) {
    for (const World& world : all_worlds()) {
        EXPECT_LE(world.rectangles.size(), 32767u) << world.name;
        for (const Rectangle& rectangle : world.rectangles) {
            const Surface& surface = world.surfaces.at(static_cast<std::size_t>(rectangle.surface));
            ASSERT_TRUE(is_valid(surface.plane)) << world.name << ", " << surface.name;
            ASSERT_LT(static_cast<std::size_t>(rectangle.texture), world.textures.size());
            const auto corners = rectangle.corners();
            for (const Vector3d& corner : corners)
                ASSERT_NEAR(surface.plane.signed_distance(corner), 0, 1e-9) << surface.name;
            ASSERT_GT((corners[1] - corners[0]).cross(corners[2] - corners[1]).dot(surface.plane.normal), 0);
            ASSERT_NEAR(rectangle.half_u.dot(rectangle.half_v), 0, 1e-9);
        }
    }
}

TEST(Worlds, AWalkKeepsItsDistance) {
    for (const World& world : all_worlds()) {
        const double round_s = tour_duration(world.tour, {}, 3);
        const Trajectory path = make_hand_path(world.tour, round_s, 0, {}, 3);
        for (std::size_t i = 0; i < path.size(); i += 60)
            EXPECT_GT(world.clearance(path[i].world_from_camera.translation()), 0.3) << world.name << i;
    }
}

TEST(Worlds, RoomsAreClosedAndClutterIsNot) {
    const PinholeCamera camera{80, 60, 65, 65, 39.5, 29.5};
    for (const World& world : all_worlds()) {
        const Trajectory path = make_hand_path(world.tour, tour_duration(world.tour, {}, 3), 0, {}, 3);
        for (std::size_t i = 0; i < path.size(); i += path.size() / 12) {
            const View view = render_view(world, camera, path[i].world_from_camera);
            const auto& seen = view.rectangle.pixels;
            auto nothing = std::count(seen.begin(), seen.end(), std::int16_t{-1});
            const auto& mirrors = view.mirror.pixels;
            nothing -= std::count_if(mirrors.begin(), mirrors.end(), [](std::int16_t m) { return m >= 0; });
            if (world.name == "clutter") {
                EXPECT_GT(nothing, 400);
                EXPECT_LT(nothing, 3600);
            } else {
                EXPECT_EQ(nothing, 0) << world.name << " " << i;
            }
        }
    }
}

TEST(Building, OneRoundIsAHundredMetres) {
    const World building = make_building(1, kCoarse);
    double length = 0;
    for (std::size_t i = 0; i < building.tour.size(); ++i) {
        const Waypoint& next = building.tour[(i + 1) % building.tour.size()];
        length += (next.position - building.tour[i].position).norm();
    }
    EXPECT_NEAR(length, 100, 2);
}

TEST(Twins, RoomsAreAlikeToTheLastPixel) {
    World twins = make_twins(1, kCoarse);
    twins.lamps.clear();  // a lamp shines through walls
    const PinholeCamera camera{160, 120, 131, 131, 79.5, 59.5};
    const Trajectory office = make_hand_path(make_office(1, kCoarse).tour, 8, 0, {}, 1);
    for (std::size_t i = 0; i < office.size(); i += 200) {
        Pose west = office[i].world_from_camera, east = west;
        east.translation().x() += 7;
        const View a = render_view(twins, camera, west), b = render_view(twins, camera, east);
        LaneImage sum_a(160, 120), sum_b(160, 120);
        shade(twins, a, 1, sum_a);
        shade(twins, b, 1, sum_b);
        int different = 0;
        for (std::size_t k = 0; k < sum_a.pixels.size(); ++k) {
            different += sum_a.pixels[k] != sum_b.pixels[k] ? 1 : 0;
            EXPECT_NEAR(a.inverse_depth.pixels[k], b.inverse_depth.pixels[k], 1e-4);
        }
        EXPECT_LT(different, 200) << "rounding at edges only";
    }
}

TEST(Twins, WhatIsOnOnePlaneIsOneSurface) {
    const World twins = make_twins(1, kCoarse);
    int north_walls = 0, west_walls = 0;
    for (const Surface& surface : twins.surfaces) {
        north_walls += surface.name.ends_with("room north wall") ? 1 : 0;
        west_walls += surface.name.ends_with("room west wall") ? 1 : 0;
    }
    EXPECT_EQ(north_walls, 1);
    EXPECT_EQ(west_walls, 2);
}

/// Pixels that differ between two views of one wall that are 2 m apart along it, of 160 x 120. `right` is as
/// seen from the place.
int differing_two_metres_on(const World& room, const Vector3d& place, const Vector3d& right) {
    const PinholeCamera camera{160, 120, 131, 131, 79.5, 59.5};
    Pose here = Pose::Identity();
    here.linear() << right, -Vector3d::UnitZ(), Vector3d::UnitZ().cross(right);
    here.translation() = place;
    Pose there = here;
    there.translation() += 2 * right;
    LaneImage seen_here(160, 120), seen_there(160, 120);
    shade(room, render_view(room, camera, here), 1, seen_here);
    shade(room, render_view(room, camera, there), 1, seen_there);
    int different = 0;
    for (std::size_t k = 0; k < seen_here.pixels.size(); ++k)
        different += seen_here.pixels[k] != seen_there.pixels[k] ? 1 : 0;
    return different;
}

TEST(Wallpaper, ComesAgainEveryTwoMetresAndTheMuralDoesNot) {
    const Vector3d before_north(1.5, 2.2, 1.3), east = Vector3d::UnitX();
    const Vector3d before_west(1.5, 1.0, 1.3), north = Vector3d::UnitY();
    const World wallpaper = make_wallpaper(1, kCoarse), mural = make_mural(1, kCoarse);
    EXPECT_LT(differing_two_metres_on(wallpaper, before_north, east), 200) << "rounding at edges only";
    EXPECT_LT(differing_two_metres_on(wallpaper, before_west, north), 200) << "rounding at edges only";
    EXPECT_GT(differing_two_metres_on(mural, before_north, east), 8000);
    EXPECT_GT(differing_two_metres_on(mural, before_west, north), 8000);
}

TEST(Wallpaper, IsCutAtTheCorners) {
    for (const World& room : {make_wallpaper(1, kCoarse), make_mural(1, kCoarse)})
        for (const Rectangle& rectangle : room.rectangles)
            for (const Vector3d& corner : rectangle.corners()) {
                EXPECT_GE(corner.minCoeff(), -1e-9);
                EXPECT_LE(corner.x(), 5 + 1e-9);
                EXPECT_LE(corner.y(), 4 + 1e-9);
            }
}

TEST(Wall, TheMiddleOfTheTourSeesNothingButPaint) {
    const World hall = make_wall(1, kCoarse);
    const PinholeCamera camera{160, 120, 131, 131, 79.5, 59.5};
    const Trajectory path = make_hand_path(hall.tour, tour_duration(hall.tour, {}, 1), 0, {}, 1);
    int bare = 0, decorated = 0;
    for (std::size_t i = 0; i < path.size(); i += 60) {
        const View view = render_view(hall, camera, path[i].world_from_camera);
        const auto [low, high] =
            std::minmax_element(view.rectangle.pixels.begin(), view.rectangle.pixels.end());
        ++(*low == *high ? bare : decorated);
    }
    EXPECT_GT(bare, 10);
    EXPECT_GT(decorated, 10);
}

TEST(Wander, StopsAtEveryPlaceAndTurnsTheShorterWay) {
    const World office = make_office(1, kCoarse);
    ASSERT_EQ(office.places.size(), 5u);
    HandOptions steady;
    steady.tremor_m = steady.tremor_deg = steady.waypoint_scatter_m = 0;
    const auto walk = wander(office.places, 14, 1);
    EXPECT_EQ(walk.size(), wander(office.places, 14, 1).size());
    const Trajectory path = make_hand_path(walk, tour_duration(walk, steady, 1), 0, steady, 1);
    int reached = 0;
    for (const Waypoint& place : office.places) {
        double nearest = 1e9;
        for (const StampedPose& pose : path)
            nearest = std::min(nearest, (pose.world_from_camera.translation() - place.position).norm());
        reached += nearest < 0.01 ? 1 : 0;
    }
    EXPECT_EQ(reached, 5);
    for (std::size_t i = 0; i < path.size(); i += 30)
        EXPECT_GT(office.clearance(path[i].world_from_camera.translation()), 0.3);
    for (std::size_t i = 1; i < path.size(); ++i) {
        const Pose step = path[i - 1].world_from_camera.inverse() * path[i].world_from_camera;
        EXPECT_LT(rotation_angle(step) * 120, 1.5) << "no faster than the hand turns";
    }
}

TEST(SimulatorParameters, LightSpeedAndVisitsDoWhatTheySay) {
    const SimulatedSource lit = small("office?"), dark = small("office?", "&light=0");
    EXPECT_EQ(dark.frame(5).depth.pixels, lit.frame(5).depth.pixels);
    for (const Rgb& pixel : dark.frame(5).color.pixels) ASSERT_EQ(int{pixel.r} + pixel.g + pixel.b, 0);

    const auto walked = [](const SimulatedSource& source) {
        const Trajectory truth = source.ground_truth();
        return (truth.front().world_from_camera.translation() - truth.back().world_from_camera.translation())
            .norm();
    };
    EXPECT_GT(walked(small("office?", "&speed=2&turn=200")), 1.5 * walked(lit));

    const SimulatedSource few(parse_simulator_name("sim:office?width=160&height=120&visits=3")),
        many(parse_simulator_name("sim:office?width=160&height=120&visits=6"));
    EXPECT_GT(*many.size(), *few.size() + 60);
    EXPECT_THAT(test::error_of([] { small("wall?visits=3&"); }),
                AllOf(HasSubstr("visits"), HasSubstr("wall")));
    EXPECT_THAT(test::error_of([] { parse_simulator_name("sim:office?light=2&speed=0&turn=0&visits=-1"); }),
                AllOf(HasSubstr("light"), HasSubstr("speed"), HasSubstr("turn"), HasSubstr("visits")));
}

TEST(SimulatorHelp, NamesEveryWorld) {
    for (const std::string& name : world_names())
        EXPECT_THAT(simulator_help(), HasSubstr("sim:" + name + " "));
}

}  // namespace
}  // namespace planemap::simulator
