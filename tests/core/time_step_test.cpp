// SPDX-License-Identifier: BSD-3-Clause
#include "core/time_step.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace planemap {
namespace {

TEST(TimeStep, TheMedianIsThatInTheMiddle) {
    std::vector<std::int64_t> one = {7}, odd = {900000, 33333, 33334}, even = {4, 1, 3, 2};
    EXPECT_EQ(median_step(one), 7);
    EXPECT_EQ(median_step(odd), 33334);
    EXPECT_EQ(median_step(even), 3) << "the later of the middle two";
}

TEST(TimeStep, OfAPartOnlyThatCounts) {
    std::vector<std::int64_t> steps = {5, 1, 3, 1000, 1000};
    EXPECT_EQ(median_step(std::span(steps).first(3)), 3);
}

}  // namespace
}  // namespace planemap
