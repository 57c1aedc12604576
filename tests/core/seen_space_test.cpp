// SPDX-License-Identifier: BSD-3-Clause
#include "core/seen_space.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace planemap {
namespace {

using Block = SeenSpace::Block;

TEST(SeenSpace, KnowsEachVoxelOfEachBlock) {
    // One voxel of each of two blocks, on both sides of the origin.
    Block a{{0, 0, 0}, {}}, b{{-1, 2, -3}, {}};
    a.free[7] = std::uint64_t{1} << (1 + 8 * 2);
    b.free[0] = std::uint64_t{1} << (7 + 8 * 7);
    const SeenSpace space({a, b});
    EXPECT_TRUE(space.is_free({0.15, 0.25, 0.75}));
    EXPECT_TRUE(space.is_free({-0.05, 2.35, -2.35}));
    int free = 0;
    for (double x = -1.55; x < 2; x += 0.1)
        for (double y = -0.75; y < 3; y += 0.1)
            for (double z = -3.15; z < 2; z += 0.1) free += space.is_free({x, y, z}) ? 1 : 0;
    EXPECT_EQ(free, 2);
    EXPECT_NEAR(space.volume(), 0.002, 1e-12);
    EXPECT_EQ(space.blocks()[0], b) << "the lower one first";
}

TEST(SeenSpace, OfPointsThatAreNowhereIsNotFree) {
    Block everywhere{{0, 0, 0}, {}};
    everywhere.free.fill(~std::uint64_t{0});
    EXPECT_TRUE(everywhere.is_full());
    const SeenSpace space({everywhere});
    EXPECT_TRUE(space.is_free({0, 0, 0}));
    EXPECT_FALSE(space.is_free({0.8, 0, 0}));
    for (const double far :
         {1e9, -1e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_FALSE(space.is_free({far, 0, 0}));
        EXPECT_FALSE(SeenSpace::block_at({0, 0, far}));
    }
    EXPECT_FALSE(SeenSpace().is_free({0, 0, 0}));
    EXPECT_TRUE(SeenSpace().empty());
}

TEST(SeenSpace, RefusesABlockThatComesTwiceAndTooMany) {
    EXPECT_THROW(SeenSpace({Block{{1, 2, 3}, {}}, Block{{0, 0, 0}, {}}, Block{{1, 2, 3}, {}}}),
                 std::invalid_argument);
    EXPECT_THROW(SeenSpace(std::vector<Block>(SeenSpace::kMostBlocks + 1)), std::invalid_argument);
}

}  // namespace
}  // namespace planemap
