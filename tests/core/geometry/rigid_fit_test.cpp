// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/rigid_fit.hpp"

#include <gtest/gtest.h>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using test::Random;

Eigen::Matrix3Xd random_points(Random& random, int count) {
    Eigen::Matrix3Xd points(3, count);
    for (int i = 0; i < count; ++i) points.col(i) = random.vector(2.0);
    return points;
}

double squared_error(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b, const Pose& a_from_b) {
    return (a - a_from_b * b).squaredNorm();
}

TEST(RigidFitTest, FindsTheMotionThatMovedThePoints) {
    Random random(1);
    for (const int count : {3, 4, 50}) {
        const Pose truth = random.pose();
        const Eigen::Matrix3Xd b = random_points(random, count);
        const Eigen::Matrix3Xd a = truth * b;
        EXPECT_TRUE(rigid_fit(a, b).isApprox(truth, 1e-9)) << count << " points";
        EXPECT_TRUE(rigid_fit(b, a).isApprox(truth.inverse(), 1e-9)) << count << " points";
    }
}

TEST(RigidFitTest, OfFixedSizeItIsTheSame) {
    Random random(2);
    const Pose truth = random.pose();
    const Eigen::Matrix3d b = random_points(random, 3), a = truth * b;
    EXPECT_TRUE(rigid_fit(a, b).isApprox(truth, 1e-9));
}

TEST(RigidFitTest, NoSmallMotionFitsNoisyPointsBetter) {
    Random random(3);
    const Eigen::Matrix3Xd b = random_points(random, 20);
    const Eigen::Matrix3Xd a = random.pose() * b + 0.3 * random_points(random, 20);
    const Pose fit = rigid_fit(a, b);
    EXPECT_TRUE(is_valid(fit));
    const double least = squared_error(a, b, fit);
    for (int i = 0; i < 6; ++i) {
        for (const double step : {-1e-3, 1e-3})
            EXPECT_GT(squared_error(a, b, fit * pose_from_twist(step * Twist::Unit(i))), least);
    }
}

TEST(RigidFitTest, AMirroredImageIsFittedByARotation) {
    Random random(4);
    const Eigen::Matrix3Xd b = random_points(random, 30);
    const Eigen::Matrix3Xd a = Eigen::Vector3d(1, 1, -1).asDiagonal() * b;
    EXPECT_TRUE(is_valid(rigid_fit(a, b)));
}

TEST(RigidFitTest, WhatThePointsLeaveOpenIsStillARotation) {
    Eigen::Matrix3Xd line(3, 4), moved(3, 4);
    line << 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0;
    moved = line.colwise() + Eigen::Vector3d(0, 5, 0);
    const Pose along = rigid_fit(moved, line);
    EXPECT_TRUE(is_valid(along));
    EXPECT_LT(squared_error(moved, line, along), 1e-18);
    const Eigen::Matrix3Xd one = line.col(2);
    const Pose to_one = rigid_fit(one, Eigen::Matrix3Xd(line.col(0)));
    EXPECT_TRUE(is_valid(to_one));
    EXPECT_LT((to_one.translation() - one).norm(), 1e-12);
}

TEST(RigidFitTest, OfACorrelationItIsTheMeansAndTheRotation) {
    Random random(5);
    const Eigen::Matrix3d rotation = random.pose().linear();
    const Eigen::Vector3d mean_a = random.vector(1), mean_b = random.vector(1);
    const Pose fit = rigid_fit(rotation, mean_a, mean_b);
    EXPECT_TRUE(fit.linear().isApprox(rotation, 1e-12));
    EXPECT_TRUE((fit * mean_b).isApprox(mean_a, 1e-12));
    EXPECT_TRUE(is_valid(rigid_fit(Eigen::Matrix3d::Zero(), mean_a, mean_b)));
}

}  // namespace
}  // namespace planemap
