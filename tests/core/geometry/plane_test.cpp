// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using test::Random;

TEST(Plane, SignedDistanceSurvivesMotion) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Plane plane{random.direction(), random.uniform(-4, 4)};
        const Pose b_from_a = random.pose();
        const Eigen::Vector3d p = random.vector(4);
        EXPECT_NEAR((b_from_a * plane).signed_distance(b_from_a * p), plane.signed_distance(p), 1e-12);
        EXPECT_TRUE(is_valid(b_from_a * plane));
    }
}

TEST(Plane, MotionComposes) {
    Random random(2);
    const Plane plane{random.direction(), 1.5};
    const Pose b_from_a = random.pose(), c_from_b = random.pose();
    const Plane at_once = (c_from_b * b_from_a) * plane, in_steps = c_from_b * (b_from_a * plane);
    EXPECT_TRUE(at_once.normal.isApprox(in_steps.normal, 1e-12));
    EXPECT_NEAR(at_once.d, in_steps.d, 1e-12);
    const Plane back = b_from_a.inverse() * (b_from_a * plane);
    EXPECT_TRUE(back.normal.isApprox(plane.normal, 1e-12));
    EXPECT_NEAR(back.d, plane.d, 1e-12);
}

TEST(Plane, ProjectionLiesOnThePlaneStraightBelow) {
    Random random(3);
    const Plane plane{random.direction(), -0.7};
    const Eigen::Vector3d p = random.vector(3), q = plane.project(p);
    EXPECT_NEAR(plane.signed_distance(q), 0, 1e-12);
    EXPECT_NEAR((p - q).cross(plane.normal).norm(), 0, 1e-12);
    EXPECT_NEAR(plane.flipped().signed_distance(p), -plane.signed_distance(p), 1e-12);
}

TEST(Plane, AngleBetweenIsExactForSmallAndLargeAngles) {
    for (const double angle : {0.0, 1e-9, 1e-4, 0.5, 3.0, std::numbers::pi - 1e-9, std::numbers::pi}) {
        const Eigen::Vector3d turned(std::sin(angle), 0, std::cos(angle));
        EXPECT_NEAR(angle_between(Eigen::Vector3d::UnitZ(), turned), angle, 1e-12);
    }
}

TEST(Plane, Validity) {
    EXPECT_TRUE(is_valid(Plane{}));
    EXPECT_FALSE(is_valid(Plane{Eigen::Vector3d::Zero(), 1}));
    EXPECT_FALSE(is_valid(Plane{Eigen::Vector3d(0, 0, 2), 1}));
    EXPECT_FALSE(is_valid(Plane{Eigen::Vector3d::UnitX(), std::numeric_limits<double>::infinity()}));
    EXPECT_FALSE(is_valid(Plane{Eigen::Vector3d(NAN, 0, 1), 1}));
}

}  // namespace
}  // namespace planemap
