// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/estimates.hpp"

#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

class EstimatesTest : public ::testing::Test {
  protected:
    EstimatesTest() { motion_.start(0); }

    /// Frame i of a camera that moves 10 mm a frame to the right, against keyframe 3 at the origin.
    OdometryEstimate follow(int i, bool degenerate = false) {
        Located located;
        located.keyframe_id = 3;
        located.track.degenerate = degenerate;
        located.track.tried = 50;
        located.track.inliers = 40;
        located.track.alignment.information = 1e6 * Matrix6d::Identity();
        Pose pose = Pose::Identity();
        pose.translation().x() = 0.01 * i;
        located.move_to(pose);
        estimates_.expect(located, motion_, i * kPeriod);
        motion_.follow(i * kPeriod, located);
        const OdometryEstimate estimate = estimates_.of(located, motion_, nullptr);
        estimates_.said(estimate);
        return estimate;
    }

    CameraMotion motion_{OdometryOptions{}};
    Estimates estimates_;
};

TEST_F(EstimatesTest, OfALocatedFrameItSaysWhereTheCameraIsAndHowItMoves) {
    OdometryEstimate estimate;
    for (int i = 1; i < 20; ++i) estimate = follow(i);
    EXPECT_EQ(estimate.status, TrackingStatus::kTracked);
    EXPECT_EQ(estimate.keyframe_id, 3);
    EXPECT_EQ(estimate.features, 50);
    EXPECT_EQ(estimate.inliers, 40);
    EXPECT_NEAR(estimate.odom_from_camera.translation().x(), 0.19, 1e-3);
    EXPECT_GT(estimate.velocity.x(), 0.2);
    EXPECT_GT(estimate.covariance(0, 0), estimates_.measured_covariance()(0, 0)) << "with the moment's";
}

TEST_F(EstimatesTest, ADegenerateFrameIsNotTracked) {
    EXPECT_EQ(follow(1, true).status, TrackingStatus::kDegenerate);
}

TEST_F(EstimatesTest, AStaleCameraStaysAndIsLessAndLessSure) {
    OdometryEstimate last;
    for (int i = 1; i < 20; ++i) last = follow(i);
    double before = last.covariance(0, 0);
    for (int i = 20; i < 24; ++i) {
        const OdometryEstimate stale = estimates_.stale(motion_, i * kPeriod, Pose::Identity());
        estimates_.said(stale);
        EXPECT_EQ(stale.status, TrackingStatus::kStale);
        EXPECT_TRUE(stale.odom_from_camera.isApprox(last.odom_from_camera));
        EXPECT_GT(stale.covariance(0, 0), before) << i;
        EXPECT_EQ(stale.velocity.norm(), 0);
        EXPECT_EQ(stale.inliers, 0);
        before = stale.covariance(0, 0);
    }
    EXPECT_LT(before, 1) << "from the last one that was not stale, each time";
}

TEST_F(EstimatesTest, ALostCameraStaysLost) {
    EXPECT_EQ(estimates_.stale(motion_, kPeriod, Pose::Identity()).status, TrackingStatus::kLost);
}

TEST_F(EstimatesTest, AKeyframeWithoutAnEdgeIsWhereTheMotionHasTheCamera) {
    Keyframe keyframe;
    keyframe.id = 8;
    follow(5);
    const OdometryEstimate estimate = Estimates::at(keyframe, motion_);
    EXPECT_EQ(estimate.status, TrackingStatus::kTracked);
    EXPECT_EQ(estimate.keyframe_id, 8);
    EXPECT_TRUE(estimate.odom_from_camera.isApprox(motion_.odom_from_camera()));
    EXPECT_TRUE(estimate.covariance.isZero());
}

}  // namespace
}  // namespace planemap::odometry
