// SPDX-License-Identifier: BSD-3-Clause
#include "graph/keyframes.hpp"

#include <gtest/gtest.h>

#include "graph/graph_parts.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;

class KeyframesTest : public testing::Test {
  protected:
    /// Ids 0, 10, 20, ...; each hangs on the one before.
    Keyframes chain(int count) {
        Keyframes keyframes;
        for (int i = 0; i < count; ++i) keyframes.add(bare_node(10 * i), random_.pose(), i - 1);
        return keyframes;
    }
    Random random_{1};
};

TEST_F(KeyframesTest, NoneHasNoNewestAndNoId) {
    const Keyframes none;
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(none.size(), 0);
    EXPECT_EQ(none.newest(), -1);
    EXPECT_EQ(none.node_of(0), -1);
    EXPECT_EQ(none.memory_bytes(), 0u);
}

TEST_F(KeyframesTest, AreFoundByTheirIds) {
    const Keyframes keyframes = chain(5);
    for (int node = 0; node < 5; ++node) EXPECT_EQ(keyframes.node_of(keyframes[node].id), node);
    for (const int id : {-1, 5, 11, 41}) EXPECT_EQ(keyframes.node_of(id), -1);
    EXPECT_EQ(keyframes.newest(), 4);
    EXPECT_EQ(keyframes.back().id, 40);
}

TEST_F(KeyframesTest, BetweenLeadsFromOneToTheOther) {
    const Keyframes keyframes = chain(3);
    EXPECT_TRUE((keyframes.pose(0) * keyframes.between(0, 2)).isApprox(keyframes.pose(2), 1e-12));
    EXPECT_TRUE(keyframes.between(1, 1).isApprox(Pose::Identity(), 1e-12));
}

TEST_F(KeyframesTest, CarryMovesTheMarkedOnesAsOne) {
    Keyframes keyframes = chain(4);
    const Keyframes before = keyframes;
    const Pose move = random_.pose();
    keyframes.carry({false, true, false, true}, move);
    for (const int node : {0, 2}) EXPECT_EQ(keyframes.pose(node).matrix(), before.pose(node).matrix());
    for (const int node : {1, 3}) EXPECT_TRUE(keyframes.pose(node).isApprox(move * before.pose(node), 1e-9));
    EXPECT_TRUE(keyframes.between(1, 3).isApprox(before.between(1, 3), 1e-9));
}

TEST_F(KeyframesTest, WhatAnOptimisationDidNotKnowFollowsWhatItHangsOn) {
    Keyframes keyframes;
    for (const int base : {-1, 0, 1, 1}) keyframes.add(bare_node(keyframes.size()), random_.pose(), base);
    const Keyframes before = keyframes;
    const std::vector<Pose> optimised{before.pose(0), random_.pose()};
    const std::vector<Pose> moves = keyframes.follow(optimised);
    ASSERT_EQ(moves.size(), 4u);
    EXPECT_EQ(keyframes.pose(1).matrix(), optimised[1].matrix());
    for (const int node : {2, 3}) {
        EXPECT_TRUE(keyframes.between(1, node).isApprox(before.between(1, node), 1e-9));
        EXPECT_TRUE((moves[at(node)] * before.pose(node)).isApprox(keyframes.pose(node), 1e-9));
    }
}

TEST_F(KeyframesTest, WhatHungOnOneThatGoesHangsOnItsKeeper) {
    Keyframes keyframes;
    for (const int base : {-1, 0, 1, 2})
        keyframes.add(bare_node(10 * keyframes.size()), random_.pose(), base);
    keyframes.remove(1, 0);
    EXPECT_EQ(keyframes.size(), 3);
    EXPECT_EQ(keyframes.node_of(10), -1);
    EXPECT_EQ(keyframes.node_of(20), 1) << "numbered without gaps";
    const Keyframes before = keyframes;
    keyframes.follow({random_.pose()});  // nobody but the first is known: all follow it
    for (const int node : {1, 2})
        EXPECT_TRUE(keyframes.between(0, node).isApprox(before.between(0, node), 1e-9));
}

}  // namespace
}  // namespace planemap::graph
