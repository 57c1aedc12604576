// SPDX-License-Identifier: BSD-3-Clause
#include "core/region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using test::Random;

/// A 2 m by 1 m rectangle with a square hole of 0.4 m in the middle, at a random pose.
PlanarRegion make_region(Random& random) {
    PlanarRegion region;
    region.box.frame_from_box = random.pose();
    region.box.half_extents = {1, 0.5, 0.01};
    region.plane = region.box.frame_from_box * Plane{};
    for (int i = 0; i < 100; ++i) {
        region.moments.add(region.box.frame_from_box *
                           Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-0.5, 0.5), 0));
    }
    region.outline.rings = {{{-1, -0.5}, {1, -0.5}, {1, 0.5}, {-1, 0.5}},
                            {{-0.2, -0.2}, {-0.2, 0.2}, {0.2, 0.2}, {0.2, -0.2}}};
    return region;
}

TEST(Region, MotionMovesEveryPartTogether) {
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const PlanarRegion a = make_region(random);
        const Pose b_from_a = random.pose();
        const PlanarRegion b = b_from_a * a;
        EXPECT_TRUE(is_valid(b));
        const Eigen::Vector3d p = random.vector(3);
        EXPECT_NEAR(distance(b, b_from_a * p), distance(a, p), 1e-9);
        const PlaneFit fit = fit_plane(b.moments);
        EXPECT_NEAR(std::abs(fit.plane.normal.dot(b.plane.normal)), 1, 1e-9);
        EXPECT_TRUE((b.box.frame_from_box.linear().col(2)).isApprox(b.plane.normal, 1e-9));
        EXPECT_NEAR(b.plane.signed_distance(b.box.frame_from_box.translation()), 0, 1e-9);
    }
}

TEST(Region, DistanceHeedsOutlineHoleAndHeight) {
    Random random(2);
    PlanarRegion region = make_region(random);
    const auto at = [&](double x, double y, double z) {
        return distance(region, region.box.frame_from_box * Eigen::Vector3d(x, y, z));
    };
    EXPECT_NEAR(at(0.7, 0.1, 0), 0, 1e-9);
    EXPECT_NEAR(at(0.7, 0.1, -0.3), 0.3, 1e-9);
    EXPECT_NEAR(at(0, 0, 0), 0.2, 1e-9) << "in the hole";
    EXPECT_NEAR(at(1.3, 0, 0.4), 0.5, 1e-9);
    region.outline = {};
    EXPECT_NEAR(at(0, 0, 0), 0, 1e-9) << "without outline the box is full";
    EXPECT_NEAR(at(1.3, 0.9, 0), 0.5, 1e-9);
}

TEST(Region, ValidityRefusesEachBadField) {
    Random random(3);
    const PlanarRegion good = make_region(random);
    EXPECT_TRUE(is_valid(good));
    EXPECT_FALSE(is_valid(PlanarRegion{})) << "no points";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refuses = [&](auto change) {
        PlanarRegion bad = good;
        change(bad);
        return !is_valid(bad);
    };
    EXPECT_TRUE(refuses([&](auto& r) { r.plane.normal *= 2; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.plane.d = nan; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.moments.count = 2; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.moments.count = nan; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.moments.count = std::numeric_limits<double>::infinity(); }));
    EXPECT_TRUE(refuses([&](auto& r) { r.moments.sum.x() = nan; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.moments.scatter(2, 1) = nan; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.box.half_extents.y() = -0.1; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.box.half_extents.y() = nan; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.box.frame_from_box.linear() *= 2; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.rms = -1; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.rms = nan; }));
    EXPECT_TRUE(refuses([&](auto& r) { r.outline.rings[0].resize(2); }));
    EXPECT_TRUE(refuses([&](auto& r) { r.outline.rings[1][2].x() = nan; }));
}

}  // namespace
}  // namespace planemap
