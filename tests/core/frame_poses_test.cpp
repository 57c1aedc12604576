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
    const std::vector<ComponentTrajectory> parts =
        place_frames(estimates, KeyframePoses(), KeyframeTrajectory());
    ASSERT_EQ(parts.size(), 1u);
    ASSERT_EQ(parts.front().trajectory.size(), 2u);
    EXPECT_EQ(parts.front().trajectory.back().utime, 1);
}

TEST(FramePoses, FramesAreInTheWorldOfTheirKeyframesComponent) {
    const auto at = [](double x) {
        Pose pose = Pose::Identity();
        pose.translation().x() = x;
        return pose;
    };
    KeyframeTrajectory graph;
    graph.keyframes = {{0, 0, at(1), 0}, {5, 50, at(20), 5}, {6, 60, at(30), 5}};
    graph.world_from_odom = at(100);
    KeyframePoses keyframes;
    keyframes.update(graph.keyframes);
    std::vector<FramePose> frames(4);
    frames[0] = {3, 0, at(0.5), at(7)};
    frames[1] = {61, 6, at(0.25), at(7)};
    frames[2] = {51, 5, at(0), at(7)};
    frames[3] = {70, 9, at(0), at(7)};  // the graph never heard of this one: the odom frame says it
    const std::vector<ComponentTrajectory> parts = place_frames(frames, keyframes, graph);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].component, 5);
    EXPECT_EQ(parts[1].component, 0);
    ASSERT_EQ(parts[0].trajectory.size(), 3u);
    EXPECT_EQ(parts[0].trajectory[0].utime, 51);
    EXPECT_DOUBLE_EQ(parts[0].trajectory[1].world_from_camera.translation().x(), 30.25);
    EXPECT_DOUBLE_EQ(parts[0].trajectory[2].world_from_camera.translation().x(), 107);
    ASSERT_EQ(parts[1].trajectory.size(), 1u);
    EXPECT_DOUBLE_EQ(parts[1].trajectory[0].world_from_camera.translation().x(), 1.5);
}

}  // namespace
}  // namespace planemap
