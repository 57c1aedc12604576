// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using test::Random;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Pose, InverseAndComposition) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Pose b_from_a = random.pose(), c_from_b = random.pose();
        const Eigen::Vector3d p_a = random.vector(5);
        EXPECT_TRUE((c_from_b * b_from_a * p_a).isApprox(c_from_b * (b_from_a * p_a), 1e-12));
        EXPECT_TRUE((b_from_a.inverse() * b_from_a).isApprox(Pose::Identity(), 1e-12));
        EXPECT_TRUE(is_valid(c_from_b * b_from_a));
    }
}

TEST(Pose, SkewIsTheCrossProduct) {
    Random random(2);
    const Eigen::Vector3d v = random.vector(2), w = random.vector(2);
    EXPECT_TRUE((skew(v) * w).isApprox(v.cross(w)));
}

TEST(Pose, LogarithmInvertsExponentialAtEveryAngle) {
    Random random(3);
    for (const double angle :
         {0.0, 1e-12, 1e-9, 1e-8, 1e-5, 0.1, 1.0, 3.0, 3.14159, std::numbers::pi - 1e-7}) {
        const Eigen::Vector3d w = angle * random.direction();
        const Eigen::Matrix3d r = so3_exp(w);
        EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-12) << angle;
        EXPECT_LT((so3_log(r) - w).norm(), 1e-7 * std::max(angle, 1e-3)) << angle;
        EXPECT_NEAR(rotation_angle(Pose(r)), angle, 1e-9);
    }
}

TEST(Pose, LogarithmStaysWithinPi) {
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Eigen::Vector3d w = random.direction() * random.uniform(3.2, 9.0);
        const Eigen::Vector3d back = so3_log(so3_exp(w));
        EXPECT_LE(back.norm(), std::numbers::pi + 1e-12);
        EXPECT_TRUE(so3_exp(back).isApprox(so3_exp(w), 1e-9));
    }
    EXPECT_NEAR(so3_log(so3_exp(std::numbers::pi * Eigen::Vector3d::UnitY())).norm(), std::numbers::pi, 1e-9);
}

TEST(Pose, ExponentialAgreesWithItsSeriesToFirstOrder) {
    const Eigen::Vector3d w(1e-6, -2e-6, 3e-6);
    EXPECT_LT((so3_exp(w) - Eigen::Matrix3d::Identity() - skew(w)).norm(), 1e-10);
}

TEST(Pose, TwistRoundTrip) {
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const Pose pose = random.pose();
        EXPECT_TRUE(pose_from_twist(twist_from_pose(pose)).isApprox(pose, 1e-10));
    }
    EXPECT_TRUE(twist_from_pose(Pose::Identity()).isZero());
}

TEST(Pose, MakePoseNormalisesTheQuaternion) {
    const Pose pose = make_pose({1, 2, 3}, Eigen::Quaterniond(2, 0, 0, 2));
    EXPECT_TRUE(is_valid(pose));
    EXPECT_NEAR(rotation_angle(pose), std::numbers::pi / 2, 1e-12);
    EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(Pose, ValidityRefusesWhatIsNoRigidTransform) {
    EXPECT_TRUE(is_valid(Pose::Identity()));
    Pose pose = Pose::Identity();
    pose.translation().x() = kNan;
    EXPECT_FALSE(is_valid(pose));
    pose = Pose::Identity();
    pose.linear() *= 1.001;
    EXPECT_FALSE(is_valid(pose));
    pose.linear() = Eigen::Vector3d(1, 1, -1).asDiagonal();
    EXPECT_FALSE(is_valid(pose)) << "a reflection";
    pose.linear().setZero();
    EXPECT_FALSE(is_valid(pose));
    pose.linear().setConstant(std::numeric_limits<double>::infinity());
    EXPECT_FALSE(is_valid(pose));
}

TEST(Pose, OrthonormalisedAfterALongProduct) {
    Random random(6);
    Pose product = Pose::Identity();
    const Pose step = random.pose(0.1, 0.1);
    for (int i = 0; i < 1000; ++i) product = product * step;
    Pose bent = product;
    bent.linear() += 1e-4 * Eigen::Matrix3d::Random();
    EXPECT_TRUE(is_valid(orthonormalised(bent)));
    EXPECT_LT((orthonormalised(bent).linear() - product.linear()).norm(), 1e-3);
    EXPECT_EQ(orthonormalised(bent).translation(), bent.translation());
}

TEST(Pose, InterpolationEndsAndMiddle) {
    Random random(7);
    for (int i = 0; i < 50; ++i) {
        const Pose a = random.pose(), b = random.pose();
        EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-10));
        EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-9));
        const Pose middle = interpolate(a, b, 0.5);
        EXPECT_TRUE(is_valid(middle));
        EXPECT_NEAR(rotation_angle(a.inverse() * middle), rotation_angle(middle.inverse() * b), 1e-9);
        EXPECT_TRUE(middle.isApprox(interpolate(b, a, 0.5), 1e-6));
    }
}

TEST(PoseTest, MovedIsThePoseOfASmallTwist) {
    Twist twist;
    twist << 0.02, -0.01, 0.03, 0.02, 0.03, -0.01;
    const Eigen::Vector3d p(0.5, -0.3, 2);
    EXPECT_LT((moved(twist, p) - pose_from_twist(twist) * p).norm(), 5e-5);
    EXPECT_EQ(moved(Twist::Zero(), p), p);
}

}  // namespace
}  // namespace planemap
