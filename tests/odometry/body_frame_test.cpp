// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/body_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace planemap::odometry {
namespace {

using Eigen::Vector3d;

/// Of a camera at `position` in its first frame, so many microseconds after the first frame.
OdometryEstimate estimate(std::int64_t utime, const Vector3d& position = Vector3d::Zero()) {
    OdometryEstimate estimate;
    estimate.utime = utime;
    estimate.odom_from_camera.translation() = position;
    return estimate;
}

/// Up in the frame of a camera that is pitched down by so much.
Vector3d up_of_pitched(double down_rad) {
    return {0, -std::cos(down_rad), -std::sin(down_rad)};
}

TEST(BodyFrame, OfAPitchedCameraIsLevelAndLooksItsWay) {
    for (const double down : {-1.57, -0.9, 0.0, 0.4, 1.2, 1.57}) {
        const Pose body_from_camera = level_body_from_camera(up_of_pitched(down));
        EXPECT_TRUE(is_valid(body_from_camera)) << down;
        EXPECT_NEAR((body_from_camera * up_of_pitched(down) - Vector3d::UnitZ()).norm(), 0, 1e-9) << down;
        const Vector3d optical_axis = body_from_camera * Vector3d::UnitZ();
        EXPECT_NEAR((optical_axis - Vector3d(std::cos(down), 0, -std::sin(down))).norm(), 0, 1e-9) << down;
        EXPECT_NEAR((body_from_camera * Vector3d::UnitX() + Vector3d::UnitY()).norm(), 0, 1e-9)
            << "right is -y";
    }
}

TEST(BodyFrame, ByUpStaysLevelAndOnTheGround) {
    constexpr double kDown = 0.5;
    BodyFrame body;
    body.hear_up(up_of_pitched(kDown));
    EXPECT_FALSE(body.is_known()) << "there is no first pose yet";
    body.see(estimate(1000000), std::nullopt);
    EXPECT_FALSE(body.is_known());
    body.hear_up(up_of_pitched(kDown));
    ASSERT_EQ(body.source(), BodyFrame::Source::kUp);
    // 5 m ahead on the level, which is up in the image of a camera that looks down.
    const Vector3d ahead = 5 * Vector3d(0, -std::sin(kDown), std::cos(kDown));
    const BodyMotion motion = body.motion(estimate(2000000, ahead));
    EXPECT_NEAR((motion.local_from_body.translation() - Vector3d(5, 0, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR(rotation_angle(motion.local_from_body), 0, 1e-9);

    body.hear_up(Vector3d::UnitX());
    body.see(estimate(9000000), Pose::Identity());
    EXPECT_EQ(body.source(), BodyFrame::Source::kUp) << "it does not change";
}

TEST(BodyFrame, ByCameraFileMovesAsTheBodyDoes) {
    // 1 m above the robot's origin and 0.3 m ahead of it, level.
    Pose body_from_camera = level_body_from_camera(-Vector3d::UnitY());
    body_from_camera.translation() = Vector3d(0.3, 0, 1);
    BodyFrame body;
    OdometryEstimate first = estimate(1000000, {0.2, 0.1, 0});
    body.see(first, body_from_camera);
    ASSERT_EQ(body.source(), BodyFrame::Source::kCameraFile);
    EXPECT_TRUE(body.motion(first).local_from_body.isApprox(Pose::Identity(), 1e-9));

    // The robot drives at 1 m/s and turns left by 0.5 rad/s about its own origin: the camera, 0.3 m ahead,
    // moves left by 0.15 m/s, and turns about its -y.
    OdometryEstimate moving = first;
    moving.velocity << -0.15, 0, 1, 0, -0.5, 0;
    BodyMotion motion = body.motion(moving);
    EXPECT_NEAR((motion.velocity_local - Vector3d(1, 0, 0)).norm(), 0, 1e-9)
        << motion.velocity_local.transpose();
    EXPECT_NEAR((motion.rotation_rate_body - Vector3d(0, 0, 0.5)).norm(), 0, 1e-9);

    // The same after the robot turned left by a right angle: velocity in the local frame, rates in the
    // body's.
    const Pose local_from_body(Eigen::AngleAxisd(M_PI_2, Vector3d::UnitZ()));
    moving.odom_from_camera = body.local_from_odom().inverse() * local_from_body * body_from_camera;
    motion = body.motion(moving);
    EXPECT_NEAR((motion.velocity_local - Vector3d(0, 1, 0)).norm(), 0, 1e-9)
        << motion.velocity_local.transpose();
    EXPECT_NEAR((motion.rotation_rate_body - Vector3d(0, 0, 0.5)).norm(), 0, 1e-9);
}

TEST(BodyFrame, WithoutUpTheCameraCountsAsLevelAfterAWhile) {
    BodyFrame body;
    for (const std::int64_t start : {500000000, 0})  // a sensor that started again
        for (int i = 0; i <= 14; ++i) body.see(estimate(start + 100000 * i), std::nullopt);
    EXPECT_FALSE(body.is_known()) << "2.8 s were waited";
    for (int i = 15; i <= 17; ++i) body.see(estimate(100000 * i), std::nullopt);
    EXPECT_EQ(body.source(), BodyFrame::Source::kAssumed);
    EXPECT_NE(body.text().find("not known"), std::string::npos);
    EXPECT_NEAR(
        (body.motion(estimate(4000000, {0, 0, 2})).local_from_body.translation() - Vector3d(2, 0, 0)).norm(),
        0, 1e-9);
}

}  // namespace
}  // namespace planemap::odometry
