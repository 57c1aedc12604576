// SPDX-License-Identifier: BSD-3-Clause
#include "core/rounding.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace planemap {
namespace {

TEST(NearestWhole, RoundsHalvesUp) {
    EXPECT_EQ(nearest_whole<int>(2.4), 2);
    EXPECT_EQ(nearest_whole<int>(2.5), 3);
    EXPECT_EQ(nearest_whole<int>(3.5f), 4);
    EXPECT_EQ(nearest_whole<int>(-0.5), 0);
    EXPECT_EQ(nearest_whole<int>(-0.25f), 0);
    EXPECT_EQ(nearest_whole<std::uint16_t>(65534.49f), 65534);
}

}  // namespace
}  // namespace planemap
