// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/moments.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using test::Random;

std::vector<Eigen::Vector3d> plane_points(Random& random, const Pose& frame_from_plane, int count,
                                          double noise) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
        points.push_back(frame_from_plane *
                         Eigen::Vector3d(random.uniform(-2, 2), random.uniform(-1, 1), random.normal(noise)));
    }
    return points;
}

Moments moments_of(const std::vector<Eigen::Vector3d>& points) {
    Moments moments;
    for (const auto& p : points) moments.add(p);
    return moments;
}

void expect_equal(const Moments& a, const Moments& b) {
    EXPECT_DOUBLE_EQ(a.count, b.count);
    EXPECT_LT((a.sum - b.sum).norm(), 1e-9 * (1 + a.sum.norm()));
    EXPECT_LT((a.scatter - b.scatter).norm(), 1e-9 * (1 + a.scatter.norm()));
}

TEST(Moments, MergingIsExact) {
    Random random(1);
    const auto all = plane_points(random, random.pose(), 300, 0.01);
    Moments merged;
    for (std::size_t part = 0; part < 3; ++part) {
        merged += moments_of({all.begin() + static_cast<std::ptrdiff_t>(100 * part),
                              all.begin() + static_cast<std::ptrdiff_t>(100 * (part + 1))});
    }
    expect_equal(merged, moments_of(all));
    const PlaneFit a = fit_plane(merged), b = fit_plane(moments_of(all));
    EXPECT_LT(angle_between(a.plane.normal, b.plane.normal), 1e-9);
    EXPECT_NEAR(a.plane.d, b.plane.d, 1e-9);
    EXPECT_NEAR(a.rms, b.rms, 1e-9);
}

TEST(Moments, MovingIsExact) {
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        auto points = plane_points(random, random.pose(), 100, 0.02);
        const Moments before = moments_of(points);
        const Pose b_from_a = random.pose(5);
        for (auto& p : points) p = b_from_a * p;
        expect_equal(b_from_a * before, moments_of(points));
        expect_equal(b_from_a.inverse() * (b_from_a * before), before);
    }
}

TEST(Moments, CovarianceOfAKnownSet) {
    const Moments moments = moments_of({{1, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, -2, 0}});
    EXPECT_TRUE(moments.mean().isZero());
    EXPECT_TRUE(moments.covariance().isApprox(Eigen::Vector3d(0.5, 2, 0).asDiagonal().toDenseMatrix()));
}

TEST(PlaneFit, FindsThePlaneItsSpreadAndAxes) {
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        const Pose camera_from_plane = random.pose();
        const Plane truth = camera_from_plane * Plane{};
        const PlaneFit fit = fit_plane(moments_of(plane_points(random, camera_from_plane, 2000, 0.01)));
        ASSERT_TRUE(fit.valid);
        EXPECT_TRUE(is_valid(fit.plane));
        const double angle = angle_between(fit.plane.normal, truth.normal);
        EXPECT_LT(std::min(angle, M_PI - angle), 0.003);
        EXPECT_NEAR(std::abs(fit.plane.d), std::abs(truth.d), 0.01);
        EXPECT_NEAR(fit.rms, 0.01, 0.001);
        EXPECT_GT(std::abs(fit.axes.col(2).dot(camera_from_plane.linear().col(0))), 0.99);
        EXPECT_LE(fit.variances[0], fit.variances[1]);
        EXPECT_LE(fit.variances[1], fit.variances[2]);
    }
}

TEST(PlaneFit, TurnsTowardsTheViewpoint) {
    Random random(4);
    for (int i = 0; i < 50; ++i) {
        const Moments moments = moments_of(plane_points(random, random.pose(), 50, 0.001));
        EXPECT_GE(fit_plane(moments).plane.d, 0);
        const Eigen::Vector3d viewpoint = random.vector(4);
        EXPECT_GE(fit_plane(moments, viewpoint).plane.signed_distance(viewpoint), 0);
    }
}

TEST(PlaneFit, DegenerateSetsAreNotValid) {
    EXPECT_FALSE(fit_plane(Moments{}).valid);
    EXPECT_FALSE(fit_plane(moments_of({{1, 2, 3}, {2, 3, 4}})).valid);
    EXPECT_FALSE(fit_plane(moments_of({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}})).valid) << "one point";
    std::vector<Eigen::Vector3d> line;
    for (int i = 0; i < 50; ++i)
        line.push_back(Eigen::Vector3d(1, 2, 3) + 0.1 * i * Eigen::Vector3d(1, -2, 0.5));
    EXPECT_FALSE(fit_plane(moments_of(line)).valid) << "a line";
    EXPECT_TRUE(fit_plane(moments_of({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}})).valid) << "three points";
}

TEST(PlaneFit, NonFiniteMomentsAreNotValid) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Moments moments = moments_of({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    moments.scatter(1, 1) = nan;
    EXPECT_FALSE(fit_plane(moments).valid);
    moments = Moments{};
    moments.count = nan;
    EXPECT_FALSE(fit_plane(moments).valid);
    moments.count = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(fit_plane(moments).valid);
}

}  // namespace
}  // namespace planemap
