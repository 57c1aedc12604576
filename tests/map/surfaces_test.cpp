// SPDX-License-Identifier: BSD-3-Clause
#include "map/surfaces.hpp"

#include <gtest/gtest.h>

#include <list>

#include "map/estimates.hpp"
#include "map/region_joiner.hpp"

namespace planemap::map {
namespace {

using samples::kRules;
using samples::stored_at;
using samples::wall_at;
using scene::Rectangle;

/// Planes that views see; view by view the rectangles, and the plane that each is part of.
struct World {
    std::list<StoredKeyframe> keyframes;
    std::vector<SeenRegion> seen;
    PlaneSet planes{kRules, 200};

    void see(const std::vector<std::pair<Rectangle, std::size_t>>& view) {
        std::vector<Rectangle> rectangles;
        for (const auto& [rectangle, plane] : view) rectangles.push_back(rectangle);
        const StoredKeyframe& keyframe = keyframes.emplace_back(stored_at(Pose::Identity(), rectangles));
        RegionJoiner joiner(observation_model({}), 0.025);
        for (std::size_t i = 0; i < view.size(); ++i) {
            const Observation observed(keyframe, keyframe.regions[i]);
            const std::size_t known = planes.estimates().size();
            const std::size_t at = view[i].second < known ? view[i].second : PlaneSet::none();
            joiner.join(planes, at, static_cast<int>(known), observed);
            seen.push_back({static_cast<int>(keyframes.size()), &keyframe, i, view[i].second,
                            observed.world_from_box()});
        }
    }
    std::size_t united() {
        unite_surfaces(planes, seen, *surface_rules({}));
        return planes.estimates().size();
    }
};

TEST(Surfaces, WhatPosesPutTwiceBecomesOne) {
    World world;
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0, 0, 3), 0}});
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0.2, 0.1, 3.09), 1}});
    EXPECT_EQ(world.united(), 1u);
    for (const SeenRegion& region : world.seen) EXPECT_EQ(region.plane, 0u);
    EXPECT_NEAR(world.planes.estimates()[0].plane.d, 3.045, 0.015) << "between both";
}

TEST(Surfaces, ABoardBeforeAWallStaysTwo) {
    World world;
    Rectangle wall = wall_at(0, 0, 2, 1);
    wall.holes = {scene::rectangle_ring(-0.3, -0.3, 0.3, 0.3)};
    for (int i = 0; i < 4; ++i) world.see({{wall, 0}, {wall_at(0, 0, 1.94, 0.3), 1}});
    EXPECT_EQ(world.united(), 2u);
    for (std::size_t i = 0; i < world.seen.size(); ++i) EXPECT_EQ(world.seen[i].plane, i % 2);
}

TEST(Surfaces, AStepSeenSideBySideStaysAStepThoughPosesSmearItsEdge) {
    World world;
    for (int i = 0; i < 4; ++i) {
        const double smear = 0.04 * i;
        world.see({{wall_at(-0.5 + smear, 0, 1.0), 0}, {wall_at(0.5 + smear, 0, 1.03), 1}});
    }
    EXPECT_EQ(world.united(), 2u);
}

TEST(Surfaces, WhatIsFartherApartThanPosesErrStaysTwo) {
    World world;
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0, 0, 1), 0}});
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0, 0, 1.2), 1}});
    EXPECT_EQ(world.united(), 2u);
}

/// A wall seen from near, and its middle again from afar, off by more than near readings ever are.
World wall_from_near_and_far(double off_m) {
    World world;
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0, 0, 6, 1.5), 0}});
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0, 0, 6 + off_m, 0.5), 1}});
    return world;
}

TEST(Surfaces, FromAfarAPartOfASurfaceMayLieFartherOff) {
    EXPECT_EQ(wall_from_near_and_far(0.2).united(), 1u);
    EXPECT_EQ(wall_from_near_and_far(0.4).united(), 2u);
}

TEST(Surfaces, AThingBeforeAFarWallThatViewsSawBesideItStaysTwo) {
    World world = wall_from_near_and_far(-0.25);
    Rectangle wall = wall_at(0, 0, 6, 1.5);
    wall.holes = {scene::rectangle_ring(-0.5, -0.5, 0.5, 0.5)};
    for (int i = 0; i < 4; ++i) world.see({{wall, 0}, {wall_at(0, 0, 5.75, 0.5), 1}});
    EXPECT_EQ(world.united(), 2u);
}

TEST(Surfaces, BesideEachOtherIsNotTwice) {
    World world;
    for (int i = 0; i < 3; ++i) world.see({{wall_at(-0.48, 0, 3), 0}});
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0.48, 0, 3.09), 1}});
    EXPECT_EQ(world.united(), 2u) << "4 cm of a metre overlap";
}

TEST(Surfaces, BothSidesOfADoorLeafStayTwo) {
    World world;
    world.see({{wall_at(0, 0, 3), 0}});
    Rectangle back = wall_at(0, 0, 3.04);
    back.world_from_face.linear() =
        back.world_from_face.linear() * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
    const StoredKeyframe& keyframe = world.keyframes.emplace_back(stored_at(
        scene::camera_at({0, 0, 6}) * Pose(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY())),
        {back}));
    RegionJoiner joiner(observation_model({}), 0.025);
    const Observation observed(keyframe, keyframe.regions[0]);
    joiner.join(world.planes, PlaneSet::none(), 1, observed);
    world.seen.push_back({2, &keyframe, 0, 1, observed.world_from_box()});
    EXPECT_EQ(world.united(), 2u);
}

TEST(Surfaces, AShapeWithoutRegionsCounts) {
    World world;
    for (int i = 0; i < 3; ++i) world.see({{wall_at(0, 0, 3), 0}});
    world.planes.push_back(samples::drawn_estimate_of(wall_at(0.1, 0, 3.07), 1));
    EXPECT_EQ(world.united(), 1u);
}

TEST(Surfaces, NothingIsLeftAsItIs) {
    World world;
    EXPECT_EQ(world.united(), 0u);
}

}  // namespace
}  // namespace planemap::map
