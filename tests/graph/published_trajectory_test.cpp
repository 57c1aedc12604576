// SPDX-License-Identifier: BSD-3-Clause
#include "graph/published_trajectory.hpp"

#include <gtest/gtest.h>

#include "graph/graph_parts.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;

/// All nodes hang together.
UnionFind<int> one_part(const Keyframes& keyframes) {
    UnionFind<int> parts(static_cast<std::size_t>(keyframes.size()));
    for (int node = 1; node < keyframes.size(); ++node) parts.join(0, node);
    return parts;
}

class PublishedTrajectoryTest : public testing::Test {
  protected:
    void add(double x) {
        Pose pose = Pose::Identity();
        pose.translation().x() = x;
        keyframes_.add(bare_node(10 * keyframes_.size(), pose), pose, keyframes_.newest());
        trajectory_.update(keyframes_, one_part(keyframes_), 0);
    }
    /// Moves all but the first along y.
    void move(double y) {
        std::vector<bool> moving(at(keyframes_.size()), true);
        moving[0] = false;
        Pose step = Pose::Identity();
        step.translation().y() = y;
        keyframes_.carry(moving, step);
        trajectory_.update(keyframes_, one_part(keyframes_), 0);
    }
    Keyframes keyframes_;
    PublishedTrajectory trajectory_{GraphOptions{}};
};

TEST_F(PublishedTrajectoryTest, IsEmptyAtFirst) {
    EXPECT_TRUE(trajectory_.get().keyframes.empty());
    EXPECT_EQ(trajectory_.get().revision, 0);
    EXPECT_TRUE(trajectory_.get().world_from_odom.isApprox(Pose::Identity()));
}

TEST_F(PublishedTrajectoryTest, NewKeyframesMakeNoRevision) {
    for (int i = 0; i < 4; ++i) add(i);
    const KeyframeTrajectory& told = trajectory_.get();
    ASSERT_EQ(told.keyframes.size(), 4u);
    EXPECT_EQ(told.revision, 0);
    EXPECT_EQ(told.keyframes[3].id, 30);
    EXPECT_EQ(told.keyframes[3].utime, 30000);
    EXPECT_EQ(told.utime, 30000);
    EXPECT_EQ(told.keyframes[2].world_from_camera.translation().x(), 2);
}

TEST_F(PublishedTrajectoryTest, AMoveMakesARevisionAndMovesTheOdomFrame) {
    add(0);
    add(1);
    move(0.5);
    EXPECT_EQ(trajectory_.get().revision, 1);
    EXPECT_NEAR(trajectory_.get().world_from_odom.translation().y(), 0.5, 1e-12);
    trajectory_.update(keyframes_, one_part(keyframes_), 7);
    EXPECT_EQ(trajectory_.get().revision, 1) << "nothing moved since";
    EXPECT_EQ(trajectory_.get().loop_closures, 7);
}

TEST_F(PublishedTrajectoryTest, SmallMovesAddUp) {
    add(0);
    add(1);
    for (int i = 0; i < 3; ++i) move(0.0004);
    EXPECT_EQ(trajectory_.get().revision, 1) << "a millimetre is one";
    EXPECT_NEAR(trajectory_.get().keyframes[1].world_from_camera.translation().y(), 0.0012, 1e-12);
}

TEST_F(PublishedTrajectoryTest, OneThatGoesIsNoMove) {
    for (int i = 0; i < 4; ++i) add(i);
    trajectory_.remove(1);
    keyframes_.remove(1, 0);
    trajectory_.update(keyframes_, one_part(keyframes_), 0);
    ASSERT_EQ(trajectory_.get().keyframes.size(), 3u);
    EXPECT_EQ(trajectory_.get().keyframes[1].id, 20);
    EXPECT_EQ(trajectory_.get().revision, 0);
}

TEST_F(PublishedTrajectoryTest, EachKeyframeNamesTheFirstThatItHangsTogetherWith) {
    for (int i = 0; i < 4; ++i) add(i);
    UnionFind<int> parts(4);
    parts.join(0, 2);
    parts.join(1, 3);
    trajectory_.update(keyframes_, parts, 0);
    const std::vector<KeyframePose>& now = trajectory_.get().keyframes;
    EXPECT_EQ(now[0].component, 0);
    EXPECT_EQ(now[1].component, 10);
    EXPECT_EQ(now[2].component, 0);
    EXPECT_EQ(now[3].component, 10);
}

}  // namespace
}  // namespace planemap::graph
