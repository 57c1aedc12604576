// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/inverse_depth.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap {
namespace {

/// Adds a point with weight 1.
void add(InverseDepthSums& s, double x, double y, double w) {
    s += {1, x, y, x * x, x * y, y * y, w, x * w, y * w, w * w};
}

InverseDepthSums points_on(const InverseDepthPlane& plane, int count, double noise, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-0.3, 0.5);
    std::normal_distribution<double> error(0, 1);
    InverseDepthSums sums;
    for (int i = 0; i < count; ++i) {
        const double x = place(random), y = place(random);
        add(sums, x, y, plane.at(x, y) + noise * error(random));
    }
    return sums;
}

TEST(InverseDepthPlaneTest, IsThePlaneInSpace) {
    const InverseDepthPlane inverse{0.3, -0.2, 0.5};
    const Plane plane = inverse.plane();
    EXPECT_TRUE(is_valid(plane));
    EXPECT_GT(plane.d, 0);
    for (const double x : {-0.4, 0.0, 0.3}) {
        for (const double y : {-0.2, 0.1}) {
            const Eigen::Vector3d p = Eigen::Vector3d(x, y, 1) / inverse.at(x, y);
            EXPECT_NEAR(plane.signed_distance(p), 0, 1e-12);
        }
    }
}

TEST(InverseDepthSumsTest, FitRecoversThePlane) {
    const InverseDepthPlane plane{0.3, -0.2, 0.5};
    const InverseDepthFit fit = points_on(plane, 100, 0, 1).fit();
    ASSERT_TRUE(fit.valid);
    EXPECT_NEAR(fit.plane.a, plane.a, 1e-10);
    EXPECT_NEAR(fit.plane.b, plane.b, 1e-10);
    EXPECT_NEAR(fit.plane.c, plane.c, 1e-10);
    EXPECT_NEAR(fit.mse, 0, 1e-12);
}

TEST(InverseDepthSumsTest, ResidualToAnotherPlaneIsThatOfThePoints) {
    const InverseDepthPlane plane{0.1, 0.2, 0.6}, other{0.12, 0.18, 0.61};
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-0.3, 0.3), error(-0.01, 0.01);
    InverseDepthSums sums;
    double squares = 0;
    for (int i = 0; i < 50; ++i) {
        const double x = place(random), y = place(random), w = plane.at(x, y) + error(random);
        add(sums, x, y, w);
        squares += (w - other.at(x, y)) * (w - other.at(x, y));
    }
    EXPECT_NEAR(sums.fit().mse_to(other), squares / 50, 1e-12);
}

TEST(InverseDepthSumsTest, SumsOfPartsAreTheSumsOfTheWhole) {
    InverseDepthSums whole = points_on({0.1, 0, 0.4}, 30, 0.01, 5);
    const InverseDepthSums part = points_on({0.2, 0, 0.4}, 20, 0.01, 6);
    InverseDepthSums both = whole;
    both += part;
    EXPECT_NEAR(both.xw, whole.xw + part.xw, 1e-12);
    // A common factor on all weights changes nothing.
    EXPECT_NEAR((7.0 * both).fit().plane.a, both.fit().plane.a, 1e-9);
    EXPECT_NEAR((7.0 * both).fit().mse, both.fit().mse, 1e-9);
}

TEST(InverseDepthSumsTest, TooFewPointsOrALineGiveNoFit) {
    InverseDepthSums sums;
    EXPECT_FALSE(sums.fit().valid);
    add(sums, 0.1, 0.1, 0.5);
    EXPECT_FALSE(sums.fit().valid);
    for (int i = 0; i < 10; ++i) add(sums, 0.1 * i, 0.1 * i, 0.5);
    EXPECT_FALSE(sums.fit().valid);
}

}  // namespace
}  // namespace planemap
