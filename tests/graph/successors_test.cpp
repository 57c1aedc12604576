// SPDX-License-Identifier: BSD-3-Clause
#include "graph/successors.hpp"

#include <gtest/gtest.h>

#include "core/random_values.hpp"

namespace planemap::graph {
namespace {

TEST(SuccessorsTest, WhoDidNotGoHasNone) {
    Successors successors;
    EXPECT_EQ(successors.of(3), nullptr);
    EXPECT_EQ(successors.of(-1), nullptr);
    EXPECT_EQ(successors.memory_bytes(), 0u);
}

TEST(SuccessorsTest, WhenAKeeperGoesItsOwnStandsForBoth) {
    test::Random random(1);
    const Pose b_from_a = random.pose(), c_from_b = random.pose();
    Successors successors;
    successors.add(1, {2, b_from_a, {0.1, 0.2}});
    successors.add(2, {3, c_from_b, {0.3, 0.4}});
    ASSERT_NE(successors.of(1), nullptr);
    EXPECT_EQ(successors.of(1)->keeper_id, 3);
    EXPECT_TRUE(successors.of(1)->keeper_from_gone.isApprox(c_from_b * b_from_a, 1e-12));
    EXPECT_DOUBLE_EQ(successors.of(1)->drift.metres, 0.4);
    EXPECT_DOUBLE_EQ(successors.of(1)->drift.radians, 0.2 + 0.4);
    EXPECT_EQ(successors.of(2)->keeper_id, 3);
    EXPECT_EQ(successors.of(3), nullptr);
}

TEST(SuccessorsTest, OfManyTheLatestIdsAreKnown) {
    Successors successors;
    for (int id = 0; id < 2000; ++id) successors.add(id, {100000, Pose::Identity(), {0, 0}});
    EXPECT_EQ(successors.of(0), nullptr);
    EXPECT_EQ(successors.of(2000 - 513), nullptr);
    EXPECT_NE(successors.of(2000 - 512), nullptr);
    EXPECT_NE(successors.of(1999), nullptr);
}

}  // namespace
}  // namespace planemap::graph
