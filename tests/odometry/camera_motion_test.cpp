// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/camera_motion.hpp"

#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

Pose at(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

/// Located at x against a keyframe at the origin.
Located located_at(double x) {
    Located located;
    located.move_to(at(x));
    return located;
}

class CameraMotionTest : public ::testing::Test {
  protected:
    /// Frames 0 to n - 1 of a camera that moves 10 mm a frame to the right.
    void walk(int n, bool filtered = true) {
        motion_.start(0);
        for (int i = 1; i < n; ++i) {
            Located located = located_at(0.01 * i);
            located.filtered = filtered;
            motion_.follow(i * kPeriod, located);
        }
    }
    CameraMotion motion_{OdometryOptions{}};
};

TEST_F(CameraMotionTest, ASteadyMotionGoesOn) {
    walk(30);
    EXPECT_TRUE(motion_.knows_velocity(30 * kPeriod));
    const Guess guess = motion_.predict(30 * kPeriod, Pose::Identity());
    EXPECT_NEAR(guess.camera_from_keyframe.inverse().translation().x(), 0.30, 1e-3);
    EXPECT_TRUE(guess.predicted_from_keyframe.isApprox(guess.camera_from_keyframe));
    EXPECT_GT(guess.velocity_gain.minCoeff(), 0);
    const Guess still = motion_.stand_still(30 * kPeriod, Pose::Identity());
    EXPECT_NEAR(still.camera_from_keyframe.inverse().translation().x(), 0.29, 1e-3);
    EXPECT_EQ(still.velocity.norm(), 0);
}

TEST_F(CameraMotionTest, TheLongerTheLessIsKnown) {
    walk(10);
    double last = std::numeric_limits<double>::infinity();
    for (const int frames : {10, 12, 20, 100}) {
        const double known = motion_.predict(frames * kPeriod, Pose::Identity()).information(0, 0);
        EXPECT_LT(known, last);
        EXPECT_GT(known, 0);
        last = known;
    }
}

TEST_F(CameraMotionTest, ALostCameraIsLookedForWhereItWas) {
    walk(10);
    motion_.lose();
    motion_.lose();
    EXPECT_EQ(motion_.lost_frames(), 2);
    EXPECT_FALSE(motion_.knows_velocity(12 * kPeriod));
    const Guess guess = motion_.predict(12 * kPeriod, Pose::Identity());
    EXPECT_NEAR(guess.camera_from_keyframe.inverse().translation().x(), 0.09, 1e-3);
    Located located = located_at(0.2);
    motion_.follow(12 * kPeriod, located);
    EXPECT_EQ(motion_.lost_frames(), 0);
    EXPECT_NEAR(motion_.odom_from_camera().translation().x(), 0.2, 1e-12) << "as measured";
    EXPECT_EQ(motion_.velocity().norm(), 0);
}

TEST_F(CameraMotionTest, AfterAPauseItMayBeAnywhere) {
    walk(10);
    EXPECT_TRUE(motion_.is_bounded(11 * kPeriod));
    EXPECT_TRUE(motion_.is_bounded(9 * kPeriod + 1400000));
    EXPECT_FALSE(motion_.is_bounded(9 * kPeriod + 1600000));
    EXPECT_FALSE(motion_.is_bounded(9 * kPeriod + 180000000));
}

TEST_F(CameraMotionTest, PosesAreTakenAsMeasuredIfAsked) {
    walk(10, false);
    EXPECT_NEAR(motion_.odom_from_camera().translation().x(), 0.09, 1e-12);
    EXPECT_EQ(motion_.velocity().norm(), 0);
    walk(10);
    Located relocalised = located_at(0.5);
    relocalised.relocalised = true;
    motion_.follow(10 * kPeriod, relocalised);
    EXPECT_NEAR(motion_.odom_from_camera().translation().x(), 0.5, 1e-12);
}

TEST_F(CameraMotionTest, JitterIsTakenOutOfThePose) {
    motion_.start(0);
    for (int i = 1; i < 60; ++i) {
        Located located = located_at(i % 2 ? 0.003 : -0.003);
        motion_.follow(i * kPeriod, located);
        EXPECT_NEAR(located.odom_from_camera().translation().x(),
                    motion_.odom_from_camera().translation().x(), 1e-9)
            << "what is located moves along";
    }
    EXPECT_LT(std::abs(motion_.odom_from_camera().translation().x()), 0.003);
}

TEST_F(CameraMotionTest, ReachGrowsWithTime) {
    walk(10);
    EXPECT_TRUE(motion_.is_plausible(at(0.1), 10 * kPeriod));
    EXPECT_FALSE(motion_.is_plausible(at(2), 10 * kPeriod));
    EXPECT_TRUE(motion_.is_plausible(at(2), 40 * kPeriod));
    Pose turned = at(0.09);
    turned.linear() = so3_exp({0, 2, 0});
    EXPECT_FALSE(motion_.is_plausible(turned, 10 * kPeriod));
}

TEST_F(CameraMotionTest, TimeThatStandsOrGoesBackKnowsNoVelocity) {
    walk(10);
    EXPECT_FALSE(motion_.knows_velocity(9 * kPeriod));
    EXPECT_FALSE(motion_.knows_velocity(0));
    EXPECT_TRUE(motion_.predict(0, Pose::Identity()).camera_from_keyframe.matrix().allFinite());
    Located located = located_at(0.3);
    motion_.follow(9 * kPeriod, located);
    EXPECT_NEAR(motion_.odom_from_camera().translation().x(), 0.3, 1e-12);
}

TEST_F(CameraMotionTest, AStartIsAtRestAtTheLastPose) {
    walk(10);
    const Pose last = motion_.odom_from_camera();
    motion_.lose();
    motion_.start(1000 * kPeriod);
    EXPECT_EQ(motion_.lost_frames(), 0);
    EXPECT_EQ(motion_.velocity().norm(), 0);
    EXPECT_TRUE(motion_.odom_from_camera().isApprox(last));
    EXPECT_EQ(motion_.seconds_since_pose(1000 * kPeriod), 0);
}

TEST_F(CameraMotionTest, AStandingCameraHasTheRightMoment) {
    motion_.start(0);
    EXPECT_EQ(motion_.covariance_of_moment(located_at(0), Twist::Zero()).norm(), 0);
}

TEST_F(CameraMotionTest, LateStampsMatterWhereTheMotionChanged) {
    walk(30);
    const Located located = located_at(0.29);
    const double same = motion_.covariance_of_moment(located, motion_.velocity())(0, 0);
    const double other = motion_.covariance_of_moment(located, Twist::Zero())(0, 0);
    const double late = 2 * OdometryOptions::stamp_sigma_s * motion_.velocity()(0);
    const double jitter = OdometryOptions{}.color_jitter_s * motion_.velocity()(0);
    EXPECT_NEAR(other - same, late * late - jitter * jitter, 1e-9) << "the keyframe's own stamp at rest";
}

TEST_F(CameraMotionTest, StampsThatJitterMatterAsFarAsTheCameraMoves) {
    OdometryOptions steady;
    steady.color_jitter_s = 0;
    CameraMotion exact{steady};
    exact.start(0);
    for (int i = 1; i < 30; ++i) {
        Located located = located_at(0.01 * i);
        exact.follow(i * kPeriod, located);
    }
    walk(30);
    const Located located = located_at(0.29);
    const double both = motion_.covariance_of_moment(located, motion_.velocity())(0, 0) -
                        exact.covariance_of_moment(located, exact.velocity())(0, 0);
    const double jitter = OdometryOptions{}.color_jitter_s * motion_.velocity()(0);
    EXPECT_NEAR(both, 2 * jitter * jitter, 1e-9) << "the frame's and the keyframe's";
}

}  // namespace
}  // namespace planemap::odometry
