// SPDX-License-Identifier: BSD-3-Clause
#include "results/table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "results/rows.hpp"

namespace planemap::results {
namespace {

const Table kTable{{"name", "name", -8}, {"frames", "frames", 6}, kBar, {"ATE mm", "ate_m", 8, 1, milli}};

TEST(Table, ShowsARowInItsOwnUnits) {
    EXPECT_EQ(kTable.heading(), "name     frames |   ATE mm\n");
    EXPECT_EQ(kTable.line({{"name", "a"}, {"frames", 300}, {"ate_m", 0.01234}, {"more", 1}}),
              "a           300 |     12.3\n");
    EXPECT_EQ(kTable.line({{"name", "a"}, {"frames", 300}, {"ate_m", nullptr}}),
              "a           300 |        -\n");
    expect_aligned(kTable, {{{"name", ""}, {"frames", nullptr}, {"ate_m", -1}}});
}

TEST(Table, WhatIsTooLongStillStandsApart) {
    EXPECT_EQ(kTable.line({{"name", "a long name"}, {"frames", 12345678}, {"ate_m", 0}}),
              "a long name 12345678 |      0.0\n");
}

TEST(Table, ARowWithoutAColumnsKeyIsAnError) {
    EXPECT_THROW(kTable.line({{"name", "a"}}), std::exception);
}

TEST(Json, HasNoNaN) {
    EXPECT_TRUE(number(NAN).is_null());
    EXPECT_TRUE(number(INFINITY).is_null());
    EXPECT_EQ(number(0.1), 0.1);
    EXPECT_TRUE(std::isnan(figure({{"a", nullptr}}, "a")));
    EXPECT_EQ(figure({{"a", 3}}, "a"), 3);
    EXPECT_TRUE(known(std::optional<int>(), [](int i) { return i; }).is_null());
    EXPECT_EQ(known(std::optional<int>(4), [](int i) { return 2 * i; }), 8);
}

}  // namespace
}  // namespace planemap::results
