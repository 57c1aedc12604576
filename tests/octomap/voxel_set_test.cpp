// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/voxel_set.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

namespace planemap::octomap {
namespace {

using Tuple = std::tuple<int, int, int>;

TEST(VoxelSet, HoldsWhatAnOrdinarySetHolds) {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<int> near(-40, 40),
        far(-VoxelSet::kMaxCoordinate, VoxelSet::kMaxCoordinate - 1);
    VoxelSet voxels;
    std::set<Tuple> expected;
    for (int i = 0; i < 50000; ++i) {
        const bool is_far = i % 7 == 0;
        const auto c = [&] { return is_far ? far(random) : near(random); };
        const Voxel v{c(), c(), c()};
        EXPECT_EQ(voxels.insert(v), expected.insert({v.x, v.y, v.z}).second);
        EXPECT_TRUE(voxels.contains(v));
    }
    EXPECT_EQ(voxels.size(), expected.size());
    std::set<Tuple> visited;
    voxels.for_each([&](const Voxel& v) { EXPECT_TRUE(visited.insert({v.x, v.y, v.z}).second); });
    EXPECT_EQ(visited, expected);
}

TEST(VoxelSet, IsEmptyAfterClear) {
    VoxelSet voxels;
    EXPECT_FALSE(voxels.contains({0, 0, 0}));
    voxels.insert({1, -2, 3});
    voxels.clear();
    EXPECT_EQ(voxels.size(), 0u);
    EXPECT_FALSE(voxels.contains({1, -2, 3}));
    EXPECT_TRUE(voxels.insert({1, -2, 3}));
}

}  // namespace
}  // namespace planemap::octomap
