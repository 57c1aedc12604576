// SPDX-License-Identifier: BSD-3-Clause
#include "map/rebuild.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "map/estimates.hpp"
#include "map/evidence_shape.hpp"

namespace planemap::map {
namespace {

using samples::kRules;
using samples::points_of;
using samples::wall_at;
using scene::camera_at;

/// Keyframes with poses, of which some regions are of planes already.
struct World {
    KeyframeStore store{200};
    FoldedPlanes folded{kRules, 200};
    PlaneIds ids;
    RegionJoiner joiner{observation_model({}), 0.025};
    MapLosses losses;

    void see(int id, const std::vector<scene::Rectangle>& seen, const std::vector<int>& planes) {
        store.add(scene::keyframe(id, seen, Pose::Identity()), losses);
        store.set_pose(id, Pose::Identity());
        for (std::size_t i = 0; i < planes.size(); ++i) {
            store.keyframes().at(id).regions[i].plane = planes[i];
            ids.reserve(planes[i]);
        }
    }
    PlaneSet rebuilt(int threads = 1) {
        PlaneSet planes(kRules, 200);
        Rebuild rebuild(store, folded, ids, joiner.model());
        rebuild.join(planes, joiner, surface_rules({}));
        rebuild.draw(planes, joiner, FreeSpace(0.05), threads);
        rebuild.carry_over_ids(planes);
        return planes;
    }
};

TEST(Rebuild, PutsAllRegionsIntoPlanesAndKeepsTheirIds) {
    World world;
    world.see(0, {wall_at(0, 0, 4, 1), wall_at(2, 0, 2, 0.4)}, {6, 3});
    world.see(1, {wall_at(0.5, 0, 4, 1)}, {6});
    const PlaneSet planes = world.rebuilt();
    ASSERT_EQ(planes.estimates().size(), 2u);
    for (const auto& [id, keyframe] : world.store.keyframes()) {
        EXPECT_TRUE(keyframe.world_from_camera.has_value());
        EXPECT_EQ(keyframe.regions[0].plane, 6);
    }
    EXPECT_EQ(world.store.keyframes().at(0).regions[1].plane, 3);
    EXPECT_EQ(world.ids.upcoming(), 7) << "no id was used up";
}

TEST(Rebuild, DoesNotDependOnWhatThePlanesWereBefore) {
    World apart, one, none;
    for (World* world : {&apart, &one, &none}) {
        for (int i = 0; i < 4; ++i)
            world->see(i, {wall_at(0.4 * i, 0, 4, 1)},
                       world == &none ? std::vector<int>{} : std::vector<int>{world == &apart ? i : 0});
    }
    const PlaneSet a = apart.rebuilt(), b = one.rebuilt(), c = none.rebuilt(4);
    ASSERT_EQ(a.estimates().size(), 1u);
    for (const PlaneSet* other : {&b, &c}) {
        ASSERT_EQ(other->estimates().size(), 1u);
        EXPECT_EQ(other->estimates()[0].plane.normal, a.estimates()[0].plane.normal);
        EXPECT_EQ(other->estimates()[0].plane.d, a.estimates()[0].plane.d);
        EXPECT_EQ(area(outline_of(other->estimates()[0].grid, samples::kOutline)),
                  area(outline_of(a.estimates()[0].grid, samples::kOutline)));
    }
}

TEST(Rebuild, LeavesKeyframesThatWaitForAPose) {
    World world;
    world.see(0, {wall_at(0, 0, 4, 1)}, {});
    world.store.add(scene::keyframe(1, {wall_at(0, 0, 2, 1)}, Pose::Identity()), world.losses);
    EXPECT_EQ(world.rebuilt().estimates().size(), 1u);
    EXPECT_TRUE(world.store.is_waiting(1));
    EXPECT_EQ(world.store.keyframes().at(1).regions[0].plane, -1);
}

TEST(Rebuild, StartsFromFoldedPlanesWhichStayAsTheyAre) {
    World world;
    world.folded.push_back(samples::drawn_estimate_of(wall_at(0, 0, 4, 1), 2));
    world.ids.reserve(2);
    const double folded = points_of(world.folded.planes());
    world.see(0, {wall_at(0.5, 0, 4, 1)}, {2});
    const auto count = static_cast<double>(world.store.keyframes().at(0).regions[0].count);
    for (int round = 0; round < 2; ++round) {
        const PlaneSet planes = world.rebuilt();
        ASSERT_EQ(planes.estimates().size(), 1u);
        EXPECT_EQ(planes.estimates()[0].id, 2);
        EXPECT_NEAR(points_of(planes.estimates()), folded + count, 1e-3);
        EXPECT_EQ(points_of(world.folded.planes()), folded);
    }
}

TEST(Rebuild, OfNothing) {
    World world;
    EXPECT_TRUE(world.rebuilt().estimates().empty());
}

}  // namespace
}  // namespace planemap::map
