// SPDX-License-Identifier: BSD-3-Clause
#include "map/belonging.hpp"

#include <gtest/gtest.h>

#include <list>
#include <numeric>

#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::kRules;
using samples::points_of;
using samples::stored_at;
using samples::wall_at;
using scene::Rectangle;

/// Regions, each seen by a view of its own, in planes that they were put into.
struct World {
    std::list<StoredKeyframe> keyframes;
    std::vector<SeenRegion> seen;
    PlaneSet planes{kRules, 200};
    RegionJoiner joiner{observation_model({}), 0.025};
    PlaneIds ids;
    SurfaceRules rules = *surface_rules({});

    void see(const Rectangle& rectangle, std::size_t plane) {
        const StoredKeyframe& keyframe = keyframes.emplace_back(stored_at(Pose::Identity(), {rectangle}));
        const Observation observed(keyframe, keyframe.regions[0]);
        const bool is_new = plane >= planes.estimates().size();
        const std::size_t at = joiner.join(planes, is_new ? PlaneSet::none() : plane,
                                           is_new ? ids.next() : planes.estimates()[plane].id, observed);
        seen.push_back({static_cast<int>(seen.size()), &keyframe, 0, at, observed.world_from_box()});
    }
    std::vector<std::size_t> reassign(std::size_t fixed = 0) {
        for (std::size_t i = 0; i < planes.estimates().size(); ++i) {
            planes.estimates()[i].refit();
            planes.update(i);
        }
        std::vector<std::size_t> order(seen.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        return reassign_strays(planes, seen, order, fixed, joiner, rules);
    }
};

TEST(Belonging, WhatBelongsStays) {
    World world;
    for (int i = 0; i < 5; ++i) world.see(wall_at(0.1 * i, 0, 3 + 0.01 * (i % 3)), 0);
    const Plane before = world.planes.estimates()[0].plane;
    EXPECT_EQ(world.reassign(), std::vector<std::size_t>{0});
    for (const SeenRegion& region : world.seen) EXPECT_EQ(region.plane, 0u);
    EXPECT_NEAR(world.planes.estimates()[0].plane.d, before.d, 1e-3);
}

TEST(Belonging, AStrayJoinsThePlaneThatItFits) {
    World world;
    for (int i = 0; i < 4; ++i) world.see(wall_at(0, 0, 3), 0);
    for (int i = 0; i < 4; ++i) world.see(wall_at(0.9, 0, 3.3), 1);
    world.see(wall_at(0.4, 0, 3.3), 0);
    world.reassign();
    ASSERT_EQ(world.planes.estimates().size(), 2u);
    EXPECT_EQ(world.seen.back().plane, 1u);
    EXPECT_NEAR(world.planes.estimates()[0].plane.d, 3, 1e-3) << "nothing of the stray is left in it";
    double points = 0;
    for (const StoredKeyframe& keyframe : world.keyframes)
        points += static_cast<double>(keyframe.regions[0].count);
    EXPECT_NEAR(points_of(world.planes.estimates()), points, 1e-3) << "none was lost or came twice";
}

TEST(Belonging, WithinTheNoiseTheMuchBetterPlaneIsTaken) {
    World world;
    for (int i = 0; i < 4; ++i) world.see(wall_at(0, 0, 2), 0);
    for (int i = 0; i < 4; ++i) world.see(wall_at(0.9, 0, 2.06), 1);
    world.see(wall_at(0.4, 0, 2.055), 0);
    world.reassign();
    ASSERT_EQ(world.planes.estimates().size(), 2u);
    EXPECT_EQ(world.seen.back().plane, 1u);
}

TEST(Belonging, WithoutAnotherPlaneItStays) {
    World world;
    for (int i = 0; i < 8; ++i) world.see(wall_at(0, 0, 2), 0);
    world.see(wall_at(0, 0, 2.2), 0);
    world.reassign();
    EXPECT_EQ(world.planes.estimates().size(), 1u);
}

TEST(Belonging, APlaneThatAllLeaveIsGone) {
    World world;
    world.see(wall_at(0, 0, 3, 1), 0);
    for (int i = 0; i < 4; ++i) world.see(wall_at(0, 0, 3, 1), 0);
    for (int i = 0; i < 2; ++i) world.see(wall_at(0.1, 0, 3.3), 1);
    for (int i = 0; i < 2; ++i) world.see(wall_at(0.1, 0, 3), 1);
    const std::vector<std::size_t> now = world.reassign();
    for (const SeenRegion& region : world.seen) ASSERT_LT(region.plane, world.planes.estimates().size());
    for (const std::size_t plane : now) EXPECT_TRUE(plane == PlaneSet::none() || plane < 2);
    for (std::size_t i = 0; i < world.seen.size(); ++i) {
        const Observation observed(*world.seen[i].keyframe, world.seen[i].stored());
        EXPECT_LT(std::sqrt(misfit2(observed.placed, world.planes.estimates()[world.seen[i].plane].plane)),
                  0.02)
            << i;
    }
}

TEST(Belonging, OfFixedPlanesNothingIsEvicted) {
    World world;
    for (int i = 0; i < 4; ++i) world.see(wall_at(0, 0, 3), 0);
    world.see(wall_at(0, 0, 2.7), 0);
    world.reassign(1);
    EXPECT_EQ(world.planes.estimates().size(), 1u);
}

TEST(Belonging, OfNothing) {
    EXPECT_TRUE(World().reassign().empty());
}

}  // namespace
}  // namespace planemap::map
