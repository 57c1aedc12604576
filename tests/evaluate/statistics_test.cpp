// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace planemap {
namespace {

TEST(NearestRank, IsOneOfTheValues) {
    EXPECT_EQ(nearest_rank({4, 1, 3, 2}, 0.5), 2);
    EXPECT_EQ(nearest_rank({4, 1, 3, 2}, 0.95), 4);
    EXPECT_EQ(nearest_rank({4, 1, 3, 2}, 0), 1);
    EXPECT_EQ(nearest_rank({7}, 0.5), 7);
    EXPECT_TRUE(std::isnan(nearest_rank({}, 0.5)));
}

}  // namespace
}  // namespace planemap
