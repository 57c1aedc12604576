// SPDX-License-Identifier: BSD-3-Clause
#include "core/timestamp.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(TimeUnitOf, GoesBySize) {
    EXPECT_EQ(time_unit_of(0), TimeUnit::kSeconds);
    EXPECT_EQ(time_unit_of(1500000000.5), TimeUnit::kSeconds);
    EXPECT_EQ(time_unit_of(1500000000500.0), TimeUnit::kMilliseconds);
    EXPECT_EQ(time_unit_of(1500000000500000.0), TimeUnit::kMicroseconds);
    EXPECT_EQ(time_unit_of(1500000000500000000.0), TimeUnit::kNanoseconds);
    EXPECT_EQ(time_unit_of(-1500000000500000000.0), TimeUnit::kNanoseconds);
    EXPECT_EQ(time_unit_of(1e11), TimeUnit::kSeconds) << "the limits themselves belong to the larger unit";
    EXPECT_EQ(time_unit_of(1e14), TimeUnit::kMilliseconds);
    EXPECT_EQ(time_unit_of(1e17), TimeUnit::kMicroseconds);
}

TEST(TimestampUs, IsExactWhereADoubleIsNot) {
    // A double holds 16 digits: of nanoseconds since the epoch it loses hundreds.
    EXPECT_EQ(timestamp_us("1500000000033333499", TimeUnit::kNanoseconds), 1500000000033333);
    EXPECT_EQ(timestamp_us("1500000000033333500", TimeUnit::kNanoseconds), 1500000000033334);
    EXPECT_EQ(timestamp_us("-1500000000033333500", TimeUnit::kNanoseconds), -1500000000033334);
    EXPECT_EQ(timestamp_us("1500000000033333", TimeUnit::kMicroseconds), 1500000000033333);
    EXPECT_EQ(timestamp_us("1500000000033.333", TimeUnit::kMilliseconds), 1500000000033333);
    EXPECT_EQ(timestamp_us("9007199254740.993001", TimeUnit::kSeconds), 9007199254740993001);
    EXPECT_EQ(timestamp_us("1305031098.6654125", TimeUnit::kSeconds), 1305031098665413);
}

TEST(TimestampUs, TakesEveryWayToWriteANumber) {
    EXPECT_EQ(timestamp_us("1.305031098665400028e+09", TimeUnit::kSeconds), 1305031098665400);
    EXPECT_EQ(timestamp_us("15e8", TimeUnit::kSeconds), 1500000000000000);
    EXPECT_EQ(timestamp_us("+.5", TimeUnit::kSeconds), 500000);
    EXPECT_EQ(timestamp_us("000001.", TimeUnit::kSeconds), 1000000);
    EXPECT_EQ(timestamp_us("0.0000005", TimeUnit::kSeconds), 1);
    EXPECT_EQ(timestamp_us("0.00000049", TimeUnit::kSeconds), 0);
    EXPECT_EQ(timestamp_us("1e-300", TimeUnit::kSeconds), 0);
    EXPECT_EQ(timestamp_us("499", TimeUnit::kNanoseconds), 0);
    EXPECT_EQ(timestamp_us("500", TimeUnit::kNanoseconds), 1);
    EXPECT_EQ(timestamp_us("-0", TimeUnit::kSeconds), 0);
}

TEST(TimestampUs, RefusesTheRest) {
    for (const char* text :
         {"", "-", ".", "e5", "1e", "1.2.3", "0x10", "nan", "inf", "1 ", " 1", "1e99999999999", "12a", "--1"})
        EXPECT_EQ(timestamp_us(text, TimeUnit::kSeconds), std::nullopt) << text;
    EXPECT_EQ(timestamp_us("9223372036854775807", TimeUnit::kMicroseconds), 9223372036854775807);
    EXPECT_EQ(timestamp_us("9223372036854775808", TimeUnit::kMicroseconds), std::nullopt);
    EXPECT_EQ(timestamp_us("9223372036854775807.5", TimeUnit::kMicroseconds), std::nullopt);
    EXPECT_EQ(timestamp_us("1e300", TimeUnit::kSeconds), std::nullopt);
}

}  // namespace
}  // namespace planemap
