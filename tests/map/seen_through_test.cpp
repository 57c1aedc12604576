// SPDX-License-Identifier: BSD-3-Clause
#include "map/seen_through.hpp"

#include <gtest/gtest.h>

#include "core/random_values.hpp"
#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::stored_at;
using samples::wall_at;

SeenSpace seen_by(const std::vector<const StoredKeyframe*>& keyframes, const SeenSpace& before = {}) {
    SeenThrough seen(0.05);
    seen.start_from(before);
    for (const StoredKeyframe* keyframe : keyframes) seen.look(Viewpoint(*keyframe));
    return seen.space();
}

/// Sees a wall of 3 x 3 m three metres ahead from a pose of the world.
StoredKeyframe before_a_wall(const Pose& world_from_camera) {
    scene::Rectangle wall = wall_at(0, 0, 3, 1.5);
    wall.world_from_face = world_from_camera * wall.world_from_face;
    return stored_at(world_from_camera, {wall});
}

TEST(SeenThrough, SpaceIsFreeUpToWhatAViewSeesAndUnknownElsewhere) {
    test::Random random(5);
    for (int i = 0; i < 20; ++i) {
        const Pose world_from_camera = random.pose();
        const StoredKeyframe keyframe = before_a_wall(world_from_camera);
        const SeenSpace space = seen_by({&keyframe});
        const auto is_free = [&](double x, double y, double z) {
            return space.is_free(world_from_camera * Eigen::Vector3d(x, y, z));
        };
        for (double z = 0.4; z < 2.7; z += 0.1) {
            for (const double aside : {-0.3, 0.0, 0.35})
                EXPECT_TRUE(z < 0.7 || is_free(aside * z, 0.2 * z, z)) << z;
            EXPECT_TRUE(is_free(0, 0, z)) << z;
            EXPECT_FALSE(is_free(0.8 * z, 0, z)) << "beside the view";
        }
        for (const double z : {-1.0, -0.3, 3.0, 3.1, 4.0, 9.0}) EXPECT_FALSE(is_free(0, 0, z)) << z;
        // A pyramid of 9 m2 and 3 m, less what lies close before the wall.
        EXPECT_GT(space.volume(), 5.5);
        EXPECT_LT(space.volume(), 9.2);
    }
}

TEST(SeenThrough, WhatViewsSawAddsUpInAnyOrder) {
    const StoredKeyframe left = before_a_wall(scene::camera_at({-2, 0, 0})),
                         right = before_a_wall(scene::camera_at({2, 0, 0}));
    const SeenSpace both = seen_by({&left, &right});
    EXPECT_EQ(both, seen_by({&right, &left}));
    EXPECT_EQ(both, seen_by({&right}, seen_by({&left})));
    EXPECT_EQ(both, seen_by({&right, &left, &right, &left}));
    EXPECT_GT(both.volume(), seen_by({&left}).volume());
}

TEST(SeenThrough, NothingIsSaidThroughAHoleWithoutARegionBehind) {
    scene::Rectangle wall = wall_at(0, 0, 3, 1.5);
    wall.holes = {scene::rectangle_ring(-0.5, -0.5, 0.5, 0.5)};
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), {wall});
    const SeenSpace space = seen_by({&keyframe});
    EXPECT_FALSE(space.is_free({0, 0, 2}));
    EXPECT_TRUE(space.is_free({0.7, 0, 2}));
    const StoredKeyframe filled = stored_at(Pose::Identity(), {wall, wall_at(0, 0, 5, 2)});
    EXPECT_TRUE(seen_by({&filled}).is_free({0, 0, 4.2}));
}

TEST(SeenThrough, OfDegenerateViews) {
    const StoredKeyframe blind = stored_at(Pose::Identity(), {});
    EXPECT_TRUE(seen_by({&blind}).empty());
    EXPECT_TRUE(seen_by({}).empty());
    StoredKeyframe far = before_a_wall(scene::camera_at({1e5, 0, 0}));
    EXPECT_TRUE(seen_by({&far}).empty()) << "farther than blocks are counted";
    // A wall 100 m away: 15 m of it.
    const StoredKeyframe wide = stored_at(Pose::Identity(), {wall_at(0, 0, 100, 20)});
    const SeenSpace space = seen_by({&wide});
    EXPECT_TRUE(space.is_free({0, 0, 14}));
    EXPECT_FALSE(space.is_free({0, 0, 16}));
}

}  // namespace
}  // namespace planemap::map
