// SPDX-License-Identifier: BSD-3-Clause
#include "core/stamp.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace planemap {
namespace {

using testing::HasSubstr;

std::int64_t utime(std::string_view text) {
    const auto stamp = read_stamp(text);
    EXPECT_TRUE(stamp) << text;
    return stamp ? stamp->utime : -1;
}

StampUnit unit(std::string_view text) {
    const auto stamp = read_stamp(text);
    EXPECT_TRUE(stamp) << text;
    return stamp ? stamp->unit : StampUnit::kSeconds;
}

TEST(Stamp, OneMomentInEveryUnit) {
    for (const char* text : {"1311868164.363181", "1311868164363.181", "1311868164363181",
                             "1311868164363181000", "+1311868164.3631810000", "1.311868164363181e+09",
                             "1311868164363181E0", "13118681643631.81e-4", "0000001311868164.363181"}) {
        EXPECT_EQ(utime(text), 1311868164363181) << text;
    }
    EXPECT_EQ(unit("1311868164.363181"), StampUnit::kSeconds);
    EXPECT_EQ(unit("1311868164363.181"), StampUnit::kMilliseconds);
    EXPECT_EQ(unit("1311868164363181"), StampUnit::kMicroseconds);
    EXPECT_EQ(unit("1311868164363181000"), StampUnit::kNanoseconds);
}

TEST(Stamp, TheUnitChangesAboveTheLimits) {
    EXPECT_EQ(unit("100000000000"), StampUnit::kSeconds);
    EXPECT_EQ(unit("100000000000.0000001"), StampUnit::kMilliseconds);
    EXPECT_EQ(unit("1e14"), StampUnit::kMilliseconds);
    EXPECT_EQ(unit("100000000000001"), StampUnit::kMicroseconds);
    EXPECT_EQ(unit("1e17"), StampUnit::kMicroseconds);
    EXPECT_EQ(unit("100000000000000001"), StampUnit::kNanoseconds);
    EXPECT_EQ(unit("-1305031229528784000"), StampUnit::kNanoseconds);
}

TEST(Stamp, TheFractionIsRoundedOnceHalvesAwayFromZero) {
    EXPECT_EQ(utime("0.0000005"), 1);
    EXPECT_EQ(utime("0.00000049999999999999999999999"), 0) << "a double would make this 0.0000005";
    EXPECT_EQ(utime("-0.0000015"), -2);
    EXPECT_EQ(utime("1403636579763555584"), 1403636579763556);
    EXPECT_EQ(utime("1403636579763555499"), 1403636579763555);
    EXPECT_EQ(utime("99999999999.9999995"), 100000000000000000);
    EXPECT_EQ(utime("0"), 0);
    EXPECT_EQ(utime("-0.0"), 0);
    EXPECT_EQ(utime("7."), 7000000);
    EXPECT_EQ(utime(".5"), 500000);
    EXPECT_EQ(utime("1e-300"), 0);
}

TEST(Stamp, EveryMicrosecondComesBack) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 10000; ++i) {
        const auto us = static_cast<std::int64_t>(random() % 4000000000000000);
        char text[64];
        std::snprintf(text, sizeof(text), "%lld.%06lld", static_cast<long long>(us / 1000000),
                      static_cast<long long>(us % 1000000));
        EXPECT_EQ(utime(text), us) << text;
    }
}

TEST(Stamp, WhatIsNoFiniteNumberIsNothing) {
    for (const char* text : {"",
                             " ",
                             "x",
                             "nan",
                             "inf",
                             "-inf",
                             "1e",
                             "1e+",
                             "e5",
                             ".",
                             "-",
                             "1.2.3",
                             "0x10",
                             "1,5",
                             "1 ",
                             " 1",
                             "1e30",
                             "1e999999999999",
                             "99999999999999999999",
                             "9223372036854775808",
                             "1_000",
                             "--1"}) {
        EXPECT_FALSE(read_stamp(text)) << text;
    }
    EXPECT_FALSE(read_stamp(std::string(100000, '1')));
    EXPECT_FALSE(read_stamp(std::string_view("1\0", 2)));
    EXPECT_TRUE(read_stamp("9223372036854775807"));
}

TEST(StampColumn, HoldsOneUnit) {
    StampColumn column;
    EXPECT_FALSE(column.unit());
    EXPECT_EQ(column.read("1311868164363181000"), 1311868164363181);
    EXPECT_EQ(column.unit(), StampUnit::kNanoseconds);
    try {
        column.read("1311868164.4");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("\"1311868164.4\" is in seconds"));
        EXPECT_THAT(error.what(), HasSubstr("\"1311868164363181000\", is in nanoseconds"));
    }
    EXPECT_THROW(column.read("nan"), std::runtime_error);
    EXPECT_EQ(column.read("1311868164363182000"), 1311868164363182) << "it goes on behind an error";
}

TEST(DateText, SortsByTimeWhateverTheZone) {
    EXPECT_EQ(date_text(0), "19700101-000000");
    EXPECT_EQ(date_text(951782400 + 3661), "20000229-010101");
}

}  // namespace
}  // namespace planemap
