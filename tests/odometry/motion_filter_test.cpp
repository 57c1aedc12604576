// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/motion_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <utility>

namespace planemap::odometry {
namespace {

constexpr double kStep = 1.0 / 30;  // seconds

Pose moving(const Twist& velocity, double t) {
    return pose_from_twist(t * velocity).inverse();
}

double off(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm();
}

TEST(MotionFilterTest, ConstantVelocityIsFollowedExactly) {
    Twist velocity;
    velocity << 0.3, -0.1, 0.2, 0, 0, 0;
    MotionFilter filter(0.2);
    filter.start(Pose::Identity());
    for (int i = 1; i < 50; ++i)
        EXPECT_LT(off(filter.update(moving(velocity, i * kStep), kStep), moving(velocity, i * kStep)), 1e-9);
    EXPECT_LT((filter.velocity() - velocity).norm(), 1e-6);
}

TEST(MotionFilterTest, RotationIsTakenAsMeasuredAndItsVelocityIsKnown) {
    Twist velocity = Twist::Zero();
    velocity(4) = 1;
    MotionFilter filter(0.2);
    filter.start(Pose::Identity());
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, 1e-3);
    for (int i = 1; i < 200; ++i) {
        Pose measured = moving(velocity, i * kStep);
        measured.linear() *= so3_exp({noise(random), noise(random), noise(random)});
        EXPECT_LT(rotation_angle(filter.update(measured, kStep).inverse() * measured), 1e-6);
    }
    EXPECT_NEAR(filter.velocity()(4), 1, 0.05);
}

/// RMS error of measured and of filtered positions on a path, metres.
std::pair<double, double> errors(const std::function<double(double)>& path, double jitter_m) {
    MotionFilter filter(0.2);
    filter.start(Pose::Identity());
    std::mt19937_64 random(2);
    std::normal_distribution<double> noise(0, jitter_m);
    double raw = 0, filtered = 0;
    constexpr int kFrames = 900, kWarm = 300;
    for (int i = 1; i <= kFrames; ++i) {
        Pose truth = Pose::Identity(), measured = truth;
        truth.translation().x() = path(i * kStep);
        measured.translation() =
            truth.translation() + Eigen::Vector3d(noise(random), noise(random), noise(random));
        const Pose out = filter.update(measured, kStep);
        if (i <= kWarm) continue;
        raw += std::pow(off(measured, truth), 2);
        filtered += std::pow(off(out, truth), 2);
    }
    return {std::sqrt(raw / (kFrames - kWarm)), std::sqrt(filtered / (kFrames - kWarm))};
}

TEST(MotionFilterTest, JitterOfASlowCameraIsTakenOut) {
    const auto [raw, filtered] = errors([](double t) { return 0.3 * std::sin(t); }, 0.004);
    EXPECT_LT(filtered, 0.7 * raw);
}

TEST(MotionFilterTest, QuickMotionIsNotSmoothedAway) {
    // A shake of 5 mm at 7 Hz, well measured.
    const auto [raw, filtered] = errors([](double t) { return 0.005 * std::sin(44 * t); }, 0.0002);
    EXPECT_LT(filtered, 2 * raw);
}

TEST(MotionFilterTest, AfterAGapAPoseIsAsMeasured) {
    Twist velocity = Twist::Zero();
    velocity(0) = 0.5;
    MotionFilter filter(0.2);
    filter.start(Pose::Identity());
    for (int i = 1; i < 20; ++i) filter.update(moving(velocity, i * kStep), kStep);
    Pose far = Pose::Identity();
    far.translation() << 1, 2, 3;
    const Pose before = filter.odom_from_camera();
    EXPECT_EQ(filter.update(far, 0.5).matrix(), far.matrix());
    EXPECT_LT((pose_from_twist(0.5 * filter.velocity()) * before.inverse() * far).translation().norm(), 1e-9);
}

TEST(MotionFilterTest, JitterIsWhatWasAdded) {
    constexpr double kSigma = 2e-3;
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, kSigma);
    Twist velocity;
    velocity << 0.3, -0.1, 0.2, 0.4, 0.3, 0.1;
    MotionFilter filter(0.2);
    filter.start(Pose::Identity());
    EXPECT_EQ(filter.jitter(), Twist::Zero());
    for (int i = 1; i < 600; ++i) {
        Twist error;
        for (double& value : error) value = noise(random);
        filter.update(moving(velocity, i * kStep) * pose_from_twist(error), kStep);
    }
    const Twist jitter = filter.jitter(), surprise = filter.surprise();
    for (int i = 3; i < 6; ++i) {
        EXPECT_GT(jitter(i), 0.3 * kSigma * kSigma) << i;
        EXPECT_LT(jitter(i), 3 * kSigma * kSigma) << i;
    }
    for (int i = 0; i < 6; ++i) EXPECT_LT(jitter(i), surprise(i)) << i;
}

}  // namespace
}  // namespace planemap::odometry
