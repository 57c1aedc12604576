// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/union_find.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace planemap {
namespace {

TEST(UnionFindTest, EachMemberStandsForItselfAtFirst) {
    UnionFind<int> sets(4);
    ASSERT_EQ(sets.size(), 4u);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(sets.find(i), i);
        EXPECT_TRUE(sets.stands(i));
    }
    EXPECT_EQ(UnionFind<int>().size(), 0u);
}

TEST(UnionFindTest, TheLeastMemberStandsWhateverTheOrder) {
    UnionFind<int> sets(5);
    EXPECT_TRUE(sets.join(4, 3));
    EXPECT_TRUE(sets.join(3, 1));
    EXPECT_FALSE(sets.join(1, 4)) << "they were one already";
    EXPECT_FALSE(sets.join(2, 2));
    for (const int i : {1, 3, 4}) EXPECT_EQ(sets.find(i), 1);
    EXPECT_TRUE(sets.stands(1));
    EXPECT_FALSE(sets.stands(4));
    EXPECT_EQ(sets.find(2), 2);
}

TEST(UnionFindTest, WhatIsAddedStandsForItselfAndTheRestStays) {
    UnionFind<std::uint16_t> sets(2);
    sets.join(0, 1);
    sets.resize(4);
    EXPECT_EQ(sets.find(1), 0);
    EXPECT_EQ(sets.find(2), 2);
    EXPECT_TRUE(sets.join(3, 1));
    EXPECT_EQ(sets.find(3), 0);
}

/// Beside the plainest way: a label a member, all of a set relabelled at each join.
TEST(UnionFindTest, AgreesWithRelabelling) {
    constexpr std::size_t kSize = 60;
    std::mt19937 random(3);
    std::uniform_int_distribution<std::size_t> pick(0, kSize - 1);
    UnionFind<std::size_t> sets(kSize);
    std::vector<std::size_t> labels(kSize);
    for (std::size_t i = 0; i < kSize; ++i) labels[i] = i;
    for (int round = 0; round < 80; ++round) {
        const std::size_t a = pick(random), b = pick(random);
        const std::size_t least = std::min(labels[a], labels[b]), most = std::max(labels[a], labels[b]);
        EXPECT_EQ(sets.join(a, b), least != most);
        for (std::size_t& label : labels) label = label == most ? least : label;
        for (std::size_t i = 0; i < kSize; ++i) EXPECT_EQ(sets.find(i), labels[i]);
    }
}

}  // namespace
}  // namespace planemap
