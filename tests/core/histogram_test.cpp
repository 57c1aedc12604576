// SPDX-License-Identifier: BSD-3-Clause
#include "core/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace planemap {
namespace {

TEST(Histogram, QuantilesAreRightWithinOnePercent) {
    std::mt19937_64 random(1);
    std::lognormal_distribution<double> distribution(0, 2);
    std::vector<double> values(5000);
    Histogram histogram;
    for (double& value : values) histogram.add(value = distribution(random));
    std::sort(values.begin(), values.end());
    for (const double q : {0.05, 0.5, 0.95}) {
        const double exact = values[static_cast<std::size_t>(q * 4999)];
        EXPECT_NEAR(histogram.quantile(q) / exact, 1, 0.0101) << q;
    }
    EXPECT_EQ(histogram.count(), 5000);
}

TEST(Histogram, ExtremesAreCounted) {
    Histogram histogram;
    EXPECT_EQ(histogram.median(), 0);
    for (const double value : {0.0, -1.0, 1e300, std::numeric_limits<double>::infinity()})
        histogram.add(value);
    histogram.add(std::nan(""));
    EXPECT_EQ(histogram.count(), 4);
    EXPECT_LT(histogram.quantile(0), 1.1e-4);
    EXPECT_GT(histogram.quantile(1), 9e4);
}

}  // namespace
}  // namespace planemap
