// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/point_sums.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap::segmentation {
namespace {

/// Adds the point at image coordinates (x, y) and inverse depth w.
void add(PointSums& s, double x, double y, double w) {
    const double Z = 1 / w, X = x * Z, Y = y * Z;
    s += {1, X, Y, Z, X * X, X * Y, X * Z, Y * Y, Y * Z, Z * Z};
}

PointSums points_on(const InverseDepthPlane& plane, int count, double noise, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-0.3, 0.5);
    std::normal_distribution<double> error(0, 1);
    PointSums sums;
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

TEST(PointSumsTest, FitRecoversThePlane) {
    const InverseDepthPlane plane{0.3, -0.2, 0.5};
    const InverseDepthFit fit = points_on(plane, 100, 0, 1).fit();
    ASSERT_TRUE(fit.valid);
    EXPECT_NEAR(fit.plane.a, plane.a, 1e-10);
    EXPECT_NEAR(fit.plane.b, plane.b, 1e-10);
    EXPECT_NEAR(fit.plane.c, plane.c, 1e-10);
    EXPECT_NEAR(fit.mse, 0, 1e-12);
}

TEST(PointSumsTest, ResidualToAnotherPlaneIsThatOfThePoints) {
    const InverseDepthPlane plane{0.1, 0.2, 0.6}, other{0.12, 0.18, 0.61};
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-0.3, 0.3), error(-0.01, 0.01);
    PointSums sums;
    double squares = 0, weights = 0;
    for (int i = 0; i < 50; ++i) {
        const double x = place(random), y = place(random), w = plane.at(x, y) + error(random);
        add(sums, x, y, w);
        squares += (w - other.at(x, y)) * (w - other.at(x, y)) / (w * w);
        weights += 1 / (w * w);
    }
    EXPECT_NEAR(sums.fit().mse_to(other), squares / weights, 1e-12);
}

TEST(PointSumsTest, SumsOfPartsAreTheSumsOfTheWhole) {
    const PointSums whole = points_on({0.1, 0, 0.4}, 30, 0.01, 5);
    const PointSums part = points_on({0.2, 0, 0.4}, 20, 0.01, 6);
    PointSums both = whole, weighted;
    both += part;
    EXPECT_NEAR(both.xz, whole.xz + part.xz, 1e-12);
    // A common factor on all weights changes nothing.
    weighted.add(7, both);
    EXPECT_NEAR(weighted.fit().plane.a, both.fit().plane.a, 1e-9);
    EXPECT_NEAR(weighted.fit().mse, both.fit().mse, 1e-9);
}

TEST(PointSumsTest, AreMoments) {
    PointSums sums;
    Moments moments;
    for (const double w : {0.3, 0.5, 0.9}) {
        add(sums, 0.2 * w, -0.1, w);
        moments.add(Eigen::Vector3d(0.2 * w, -0.1, 1) / w);
    }
    EXPECT_EQ(sums.moments().count, 3);
    EXPECT_TRUE(sums.moments().sum.isApprox(moments.sum, 1e-12));
    EXPECT_TRUE(sums.moments().scatter.isApprox(moments.scatter, 1e-12));
}

TEST(PointSumsTest, TooFewPointsOrALineGiveNoFit) {
    PointSums sums;
    EXPECT_FALSE(sums.fit().valid);
    add(sums, 0.1, 0.1, 0.5);
    EXPECT_FALSE(sums.fit().valid);
    for (int i = 0; i < 10; ++i) add(sums, 0.1 * i, 0.1 * i, 0.5);
    EXPECT_FALSE(sums.fit().valid);
}

}  // namespace
}  // namespace planemap::segmentation
