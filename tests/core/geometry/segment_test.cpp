// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/segment.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

using Eigen::Vector2d;

TEST(Segment, NearestIsWithinOrAnEnd) {
    EXPECT_EQ(nearest_on_segment({1, 5}, {0, 0}, {2, 0}), Vector2d(1, 0));
    EXPECT_EQ(nearest_on_segment({-1, 5}, {0, 0}, {2, 0}), Vector2d(0, 0));
    EXPECT_EQ(nearest_on_segment({3, 5}, {0, 0}, {2, 0}), Vector2d(2, 0));
    EXPECT_EQ(nearest_on_segment({3, 4}, {0, 0}, {0, 0}), Vector2d(0, 0));
    EXPECT_DOUBLE_EQ(distance_to_segment({3, 4}, {0, 0}, {0, 0}), 5);
}

TEST(Segment, AnEndOnTheLineCountsAsBelow) {
    EXPECT_TRUE(crosses({0, 0}, {0, 1}, 0));
    EXPECT_FALSE(crosses({0, 0}, {0, 1}, 1));
    EXPECT_FALSE(crosses({0, 1}, {5, 1}, 1));
    EXPECT_DOUBLE_EQ(x_of_crossing({1, 0}, {3, 4}, 1), 1.5);
    EXPECT_TRUE(passes_right_of({1, 1}, {1, 0}, {3, 4}));
    EXPECT_FALSE(passes_right_of({1.5, 1}, {1, 0}, {3, 4}));
    EXPECT_FALSE(passes_right_of({0, 5}, {1, 0}, {3, 4}));
}

}  // namespace
}  // namespace planemap
