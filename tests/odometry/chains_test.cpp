// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/chains.hpp"

#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

TEST(Chains, AKeyframeWithoutAnEdgeBeginsOneAndOthersFollowTheirs) {
    Chains chains;
    EXPECT_EQ(chains.add(0, -1), 0);
    EXPECT_EQ(chains.add(1, 0), 0);
    EXPECT_EQ(chains.add(2, -1), 2);
    EXPECT_EQ(chains.add(3, 2), 2);
    EXPECT_EQ(chains.add(4, 1), 0) << "found again";
    EXPECT_EQ(chains.add(5, 4), 0);
    EXPECT_EQ(chains.of(1), 0);
    EXPECT_EQ(chains.of(3), 2);
    EXPECT_EQ(chains.of(5), 0);
}

TEST(Chains, WhatIsNotKnownIsSaidToBe) {
    Chains chains;
    EXPECT_EQ(chains.of(3), -1);
    chains.remember(7, 5);
    EXPECT_EQ(chains.of(6), -1);
    EXPECT_EQ(chains.add(8, 6), -1);
    EXPECT_EQ(chains.add(9, 7), 5);
}

TEST(Chains, LossesWithoutEndTakeNoMemoryWithoutEnd) {
    Chains chains;
    for (int id = 0; id < 20000; ++id) EXPECT_EQ(chains.add(id, -1), id);
    EXPECT_EQ(chains.of(10), -1);
    EXPECT_EQ(chains.of(19999), 19999);
}

}  // namespace
}  // namespace planemap::odometry
