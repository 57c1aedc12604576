// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_building.hpp"

#include <gtest/gtest.h>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

using namespace std::chrono_literals;
using test::pose;
using test::room;
using test::small_camera;

/// Three keyframes, each added when the trajectory names it.
KeyframeTrajectory give(TreeBuilding& tree) {
    KeyframeTrajectory trajectory = test::trajectory({pose(0, 0), pose(0.2, 0.1), pose(0.4, 0.2)});
    trajectory.utime = 7;
    trajectory.revision = 3;
    tree.begin_update(trajectory);
    for (const KeyframePose& keyframe : trajectory.keyframes)
        EXPECT_TRUE(tree.add(keyframe.id, std::make_shared<StoredScan>(room(small_camera()), small_camera()),
                             keyframe.world_from_camera, {keyframe.id, Pose::Identity()}));
    tree.end_update(trajectory);
    return trajectory;
}

TEST(TreeBuilding, InTheHandlerAndInTheBackgroundTheTreeIsTheSame) {
    TreeBuilding handler({}, Building::kInHandler), background({}, Building::kInBackground);
    EXPECT_FALSE(handler.is_in_background());
    EXPECT_TRUE(background.is_in_background());
    give(handler);
    give(background);
    const OctomapState state = handler.state_up_to_date();
    EXPECT_EQ(state.keyframes, 3u);
    EXPECT_EQ(state.utime, 7);
    EXPECT_EQ(state.revision, 3);
    EXPECT_TRUE(state.is_up_to_date);
    background.finish(60s);
    const std::optional<OctomapState> other = background.newer_state();
    ASSERT_TRUE(other.has_value());
    EXPECT_EQ(other->keyframes, state.keyframes);
    EXPECT_EQ(other->revision, state.revision);
    EXPECT_EQ(background.builder().bt(), handler.builder().bt());
}

TEST(TreeBuilding, StartsOverWithAnEmptyTreeWhereItWasBuilt) {
    for (const Building building : {Building::kInHandler, Building::kInBackground}) {
        TreeBuilding tree({}, building);
        give(tree);
        if (tree.is_in_background()) tree.finish(60s);
        EXPECT_EQ(tree.start_over(), 3u);
        EXPECT_EQ(tree.is_in_background(), building == Building::kInBackground);
        give(tree);
        if (tree.is_in_background()) tree.finish(60s);
        EXPECT_EQ(tree.builder().keyframes_in_tree(), 3u);
    }
}

}  // namespace
}  // namespace planemap::octomap
