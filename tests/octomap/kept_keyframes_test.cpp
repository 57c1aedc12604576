// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/kept_keyframes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

using test::pose;
using test::room;
using test::small_camera;
using test::trajectory;

std::shared_ptr<const StoredScan> scan() {
    static const auto shared = std::make_shared<const StoredScan>(room(small_camera()), small_camera());
    return shared;
}

/// Keyframes 0, 1, 2 ... of a row, 0.2 m apart; all of them in the tree, each in a block of its own.
KeptKeyframes row(int count) {
    KeptKeyframes keyframes{OctomapOptions{}};
    for (int id = 0; id < count; ++id) {
        EXPECT_TRUE(keyframes.keep(id, scan(), pose(0.2 * id, 0)));
        keyframes.enter(id, {{id, 0, 0}});
    }
    return keyframes;
}

TEST(KeptKeyframes, WaitForTheTreeByAscendingId) {
    KeptKeyframes keyframes{OctomapOptions{}};
    EXPECT_EQ(keyframes.next_waiting(), nullptr);
    for (const int id : {7, 3, 5}) EXPECT_TRUE(keyframes.keep(id, scan(), pose(0, 0)));
    EXPECT_FALSE(keyframes.has_oldest_entered());
    for (const int id : {3, 5, 7}) {
        ASSERT_NE(keyframes.next_waiting(), nullptr);
        EXPECT_EQ(keyframes.next_waiting()->first, id);
        keyframes.enter(id, {});
    }
    EXPECT_EQ(keyframes.waiting(), 0u);
    EXPECT_EQ(keyframes.inside(), 3u);
    EXPECT_EQ(keyframes.misplaced(), 0u);
    EXPECT_TRUE(keyframes.has_oldest_entered());
}

TEST(KeptKeyframes, OneThatComesTooLateIsForTheRebuild) {
    KeptKeyframes keyframes{OctomapOptions{}};
    keyframes.keep(3, scan(), pose(0, 0));
    keyframes.enter(3, {});
    EXPECT_TRUE(keyframes.keep(2, scan(), pose(0, 0)));
    EXPECT_TRUE(keyframes.keep(2, scan(), pose(0.1, 0))) << "again";
    EXPECT_EQ(keyframes.misplaced(), 1u) << "counts once";
    EXPECT_EQ(keyframes.waiting(), 0u);
    EXPECT_EQ(keyframes.inside(), 1u);
    keyframes.take_misplaced();
    EXPECT_EQ(keyframes.misplaced(), 0u);
    keyframes.rebuilt(2, {{1, 2, 3}});
    EXPECT_EQ(keyframes.inside(), 2u);
    EXPECT_EQ(keyframes.all().at(2).blocks, (std::vector<Voxel>{{1, 2, 3}}));
}

TEST(KeptKeyframes, SmallMotionsAddUpAndLargeOnesCountAtOnce) {
    KeptKeyframes keyframes = row(2);
    keyframes.move(trajectory({pose(0.0015, 0), pose(0.2, 0)}));
    EXPECT_EQ(keyframes.misplaced(), 0u);
    keyframes.move(trajectory({pose(0.003, 0), pose(0.2, 0)}));
    EXPECT_EQ(keyframes.misplaced(), 1u) << "3 mm since it entered the tree";
    keyframes.move(trajectory({pose(0.003, 0), pose(0.2, 0.01)}));
    EXPECT_EQ(keyframes.misplaced(), 2u) << "turned";
}

TEST(KeptKeyframes, OneThatWaitsMovesWithoutBeingMisplaced) {
    KeptKeyframes keyframes{OctomapOptions{}};
    keyframes.keep(0, scan(), pose(0, 0));
    keyframes.move(trajectory({pose(1, 0)}));
    EXPECT_EQ(keyframes.misplaced(), 0u);
    EXPECT_TRUE(keyframes.next_waiting()->second.world_from_camera.isApprox(pose(1, 0)));
}

TEST(KeptKeyframes, AReplacedOneMovesWithItsReplacement) {
    KeptKeyframes keyframes = row(3);
    KeyframeTrajectory named = trajectory({pose(0, 0), pose(0.2, 0), pose(0.4, 0)});
    keyframes.move(named);
    named.keyframes.pop_back();
    for (KeyframePose& keyframe : named.keyframes)
        keyframe.world_from_camera.translation() += Eigen::Vector3d(0, 0, 1);
    keyframes.move(named);
    EXPECT_EQ(keyframes.misplaced(), 3u);
    EXPECT_NEAR(keyframes.all().at(2).world_from_camera.translation().z(), pose(0, 0).translation().z() + 1,
                1e-12);
}

TEST(KeptKeyframes, WhatWasLetGoDoesNotComeAgain) {
    KeptKeyframes keyframes = row(3);
    keyframes.move(trajectory({pose(0.1, 0), pose(0.2, 0), pose(0.4, 0)}));
    ASSERT_EQ(keyframes.misplaced(), 1u);
    const auto [id, gone] = keyframes.let_oldest_go();
    EXPECT_EQ(id, 0);
    EXPECT_TRUE(gone.misplaced);
    EXPECT_EQ(gone.blocks, (std::vector<Voxel>{{0, 0, 0}}));
    EXPECT_EQ(keyframes.misplaced(), 0u) << "its own was taken off the count";
    EXPECT_FALSE(keyframes.holds(0));
    EXPECT_FALSE(keyframes.keep(0, scan(), pose(0, 0)));
    EXPECT_FALSE(keyframes.keep(-1, scan(), pose(0, 0)));
    EXPECT_TRUE(keyframes.keep(1, scan(), pose(0, 0)));
}

TEST(KeptKeyframes, AnInvalidPoseIsNotTaken) {
    KeptKeyframes keyframes = row(1);
    Pose nan = Pose::Identity();
    nan.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(keyframes.keep(1, scan(), nan));
    EXPECT_FALSE(keyframes.holds(1));
    keyframes.move(trajectory({nan}));
    EXPECT_TRUE(is_valid(keyframes.all().at(0).world_from_camera));
}

TEST(KeptKeyframes, TakeTheBytesOfTheirScans) {
    EXPECT_GE(row(3).bytes(), 3 * scan()->bytes());
    EXPECT_EQ(row(0).bytes(), 0u);
    EXPECT_EQ(row(0).voxel_cloud(0.01, 1).size(), 0u);
    EXPECT_LT(row(1).voxel_cloud(0.01, 4).size(), row(1).voxel_cloud(0.01, 1).size());
}

TEST(KeptKeyframes, LooksComeAfterTheirKeyframeAndMoveWithTheirAnchor) {
    KeptKeyframes keyframes = row(2);
    const Pose beside = pose(0.1, 0);
    EXPECT_TRUE(keyframes.keep({1, 2}, scan(), beside, {0, beside}));
    EXPECT_TRUE(keyframes.keep({1, 1}, scan(), beside, {0, beside}));
    for (const int look : {1, 2}) {
        ASSERT_NE(keyframes.next_waiting(), nullptr);
        EXPECT_EQ(keyframes.next_waiting()->first, ScanId(1, look)) << "in order of time";
        keyframes.enter({1, look}, {});
    }
    keyframes.move(trajectory({pose(1, 0), pose(0.2, 0)}));
    EXPECT_EQ(keyframes.misplaced(), 3u) << "keyframe 0 and its looks";
    EXPECT_TRUE(keyframes.all().at({1, 1}).world_from_camera.isApprox(pose(1, 0) * beside, 1e-12));
}

}  // namespace
}  // namespace planemap::octomap
