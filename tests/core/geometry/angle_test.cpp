// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/angle.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(Angle, DegreesAndRadiansAreInverse) {
    EXPECT_DOUBLE_EQ(radians(180), std::numbers::pi);
    EXPECT_DOUBLE_EQ(degrees(std::numbers::pi / 2), 90);
    for (const double angle : {-720.0, -1e-9, 0.0, 0.3, 56.0, 360.0})
        EXPECT_DOUBLE_EQ(degrees(radians(angle)), angle);
    static_assert(radians(0) == 0);
}

}  // namespace
}  // namespace planemap
