// SPDX-License-Identifier: BSD-3-Clause
#include "core/frame_poses.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

OdometryEstimate estimate(TrackingStatus status, double sigma_m, double sigma_rad) {
    OdometryEstimate estimate;
    estimate.status = status;
    estimate.covariance.diagonal() << Eigen::Vector3d::Constant(sigma_m * sigma_m),
        Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
    return estimate;
}

TEST(FramePoses, AStaleFrameHasAPlaceWhileItCannotBeFarOff) {
    using enum TrackingStatus;
    EXPECT_TRUE(is_placed(estimate(kTracked, 1, 1)));
    EXPECT_TRUE(is_placed(estimate(kDegenerate, 1, 1)));
    EXPECT_FALSE(is_placed(estimate(kLost, 0, 0)));
    EXPECT_TRUE(is_placed(estimate(kStale, 0.02, 0.02)));
    EXPECT_FALSE(is_placed(estimate(kStale, 0.06, 0.02)));
    EXPECT_FALSE(is_placed(estimate(kStale, 0.02, 0.05)));
    EXPECT_FALSE(is_tracked(kStale));
}

TEST(FramePoses, WhatHasNoPlaceIsLeftOut) {
    std::vector<OdometryEstimate> estimates{
        estimate(TrackingStatus::kTracked, 0.01, 0.01), estimate(TrackingStatus::kStale, 0.02, 0.02),
        estimate(TrackingStatus::kStale, 0.2, 0.02), estimate(TrackingStatus::kLost, 0, 0)};
    for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i].pose_utime = static_cast<std::int64_t>(i);
    const Trajectory trajectory = place_frames(estimates, KeyframePoses(), Pose::Identity());
    ASSERT_EQ(trajectory.size(), 2u);
    EXPECT_EQ(trajectory.back().utime, 1);
}

}  // namespace
}  // namespace planemap
