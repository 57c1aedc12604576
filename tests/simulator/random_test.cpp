// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace planemap::simulator {
namespace {

TEST(Random, GaussianHasUnitVarianceAndNoSkew) {
    const GaussianTable gaussian;
    double sum = 0, squares = 0;
    for (std::uint64_t i = 0; i <= GaussianTable::kMask; ++i) {
        sum += gaussian[i];
        squares += gaussian[i] * gaussian[i];
        EXPECT_NEAR(gaussian[i], -gaussian[GaussianTable::kMask - i], 1e-5);
    }
    EXPECT_NEAR(sum, 0, 1e-2);
    EXPECT_NEAR(squares / (GaussianTable::kMask + 1), 1, 1e-5);
    EXPECT_NEAR(gaussian[GaussianTable::kMask / 2], 0, 1e-3);
}

TEST(Random, NeighbouringIndicesAreUnrelated) {
    double sum = 0, products = 0, before = 0.5;
    constexpr int kCount = 20000;
    for (std::uint64_t i = 0; i < kCount; ++i) {
        const double value = uniform(mix(7, i));
        sum += value;
        products += (value - 0.5) * (before - 0.5);
        before = value;
    }
    EXPECT_NEAR(sum / kCount, 0.5, 0.01);
    EXPECT_NEAR(products / kCount, 0, 0.003);
    EXPECT_NE(mix(1, 2), mix(2, 1));
}

}  // namespace
}  // namespace planemap::simulator
