// SPDX-License-Identifier: BSD-3-Clause
#include "core/number_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace planemap {
namespace {

TEST(ShortNumberText, HasSixDigitsAndNoZerosAtItsEnd) {
    EXPECT_EQ(short_number_text(0.1), "0.1");
    EXPECT_EQ(short_number_text(-3), "-3");
    EXPECT_EQ(short_number_text(2.0 / 3), "0.666667");
    EXPECT_EQ(short_number_text(1234567), "1.23457e+06");
    EXPECT_EQ(short_number_text(std::numeric_limits<double>::infinity()), "inf");
    EXPECT_EQ(short_number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

}  // namespace
}  // namespace planemap
