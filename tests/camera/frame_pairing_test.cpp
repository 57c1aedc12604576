// SPDX-License-Identifier: BSD-3-Clause
#include "camera/frame_pairing.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace planemap::camera {
namespace {

constexpr std::int64_t kPeriod = 33333;
using Pairing = FramePairing<int>;

TEST(FramePairing, NearestColourWithinTheGapAndEachOnce) {
    std::mt19937 random(3);
    Pairing pairing(kPeriod / 2);
    std::set<int> used;
    std::int64_t depths = 0, alone = 0;
    const auto take_all = [&] {
        while (const auto pair = pairing.take()) {
            EXPECT_EQ(pair->depth, depths++) << "every depth frame, in order";
            if (!pair->color) {
                ++alone;
                continue;
            }
            EXPECT_LE(std::abs(pair->color_us - pair->depth_us), kPeriod / 2);
            EXPECT_TRUE(used.insert(*pair->color).second);
        }
    };
    int colors = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::int64_t at = kPeriod * i;
        if (random() % 10 != 0) pairing.add_color(at + 4000, colors++);
        pairing.add_depth(at, i);
        take_all();
    }
    pairing.end();
    take_all();
    EXPECT_EQ(depths, 1000);
    EXPECT_EQ(static_cast<int>(used.size()) + pairing.unpaired_colors(), colors);
    EXPECT_GT(alone, 50);
    EXPECT_LT(alone, 150);
}

TEST(FramePairing, OfTwoColourFramesTheNearer) {
    Pairing pairing(kPeriod / 2);
    pairing.add_color(90000, 1);
    pairing.add_color(101000, 2);
    pairing.add_depth(100000, 7);
    const auto pair = pairing.take();
    ASSERT_TRUE(pair && pair->color);
    EXPECT_EQ(*pair->color, 2);
    EXPECT_FALSE(pairing.take());
}

TEST(FramePairing, ColourThatStopsHoldsDepthUpByTwoFrames) {
    Pairing pairing(kPeriod / 2);
    for (int i = 0; i < 10; ++i) {
        pairing.add_depth(kPeriod * i, i);
        const auto pair = pairing.take();
        EXPECT_EQ(pair.has_value(), i >= 2);
        if (pair) {
            EXPECT_EQ(pair->depth, i - 2);
            EXPECT_FALSE(pair->color);
        }
    }
}

TEST(FramePairing, WithoutColourDepthComesAtOnce) {
    Pairing pairing(kPeriod / 2);
    pairing.expect_color(false);
    pairing.add_depth(5, 1);
    EXPECT_TRUE(pairing.take());
}

}  // namespace
}  // namespace planemap::camera
