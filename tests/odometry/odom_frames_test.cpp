// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odom_frames.hpp"

#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

Pose at(double x, double angle = 0) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
    return pose;
}

Keyframe keyframe(int id, int chain, const Pose& odom_from_camera) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.chain = chain;
    keyframe.utime = 1000 * id;
    keyframe.odom_from_camera = odom_from_camera;
    return keyframe;
}

KeyframePose named(int id, const Pose& world_from_camera, int component) {
    KeyframePose pose{id, 1000 * id, world_from_camera};
    pose.component = component;
    return pose;
}

TEST(OdomFrames, TheFirstOneLiesOnItself) {
    OdomFrames frames;
    EXPECT_FALSE(frames.wants_trajectory(true)) << "there is nothing that one could tell";
    frames.add(keyframe(0, 0, at(1)));
    ASSERT_TRUE(frames.first_from(0));
    EXPECT_TRUE(frames.first_from(0)->isApprox(Pose::Identity()));
    EXPECT_FALSE(frames.first_from(7));
    EXPECT_FALSE(frames.odom_from_world());
    EXPECT_TRUE(frames.wants_trajectory(true));
    EXPECT_FALSE(frames.wants_trajectory(false));
}

TEST(OdomFrames, ATrajectoryInOneComponentSaysHowTheyLie) {
    const Pose world_from_first = at(3, 0.2), world_from_second = at(-2, 1.0);
    OdomFrames frames;
    frames.add(keyframe(0, 0, at(1)));
    frames.add(keyframe(1, 0, at(2)));
    frames.add(keyframe(5, 5, at(0.5, 0.3)));
    frames.add(keyframe(6, 5, at(0.7, 0.3)));
    EXPECT_TRUE(frames.wants_trajectory(false));
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {named(0, world_from_first * at(1), 0),
                            named(5, world_from_second * at(0.5, 0.3), 5)};
    frames.hear(trajectory);
    EXPECT_TRUE(frames.odom_from_world()->isApprox(world_from_first.inverse(), 1e-9));
    EXPECT_FALSE(frames.first_from(5)) << "they are components of their own";
    trajectory.keyframes.back().component = 0;
    frames.hear(trajectory);
    ASSERT_TRUE(frames.first_from(5));
    EXPECT_TRUE(frames.first_from(5)->isApprox(world_from_first.inverse() * world_from_second, 1e-9));
    EXPECT_FALSE(frames.wants_trajectory(false));
}

TEST(OdomFrames, AnotherSessionsTrajectoryTellsNothing) {
    OdomFrames frames;
    frames.add(keyframe(0, 0, at(1)));
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{0, 77, at(4)}};
    frames.hear(trajectory);
    EXPECT_FALSE(frames.odom_from_world());
}

TEST(OdomFrames, OfManyTheNewestAreKept) {
    OdomFrames frames;
    frames.add(keyframe(0, 0, at(0)));
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {named(0, at(0), 0)};
    for (int id = 1; id <= 200; ++id) {
        frames.add(keyframe(id, id, at(0)));
        trajectory.keyframes.push_back(named(id, at(id), 0));
    }
    frames.hear(trajectory);
    EXPECT_FALSE(frames.first_from(1));
    ASSERT_TRUE(frames.first_from(200));
    EXPECT_NEAR(frames.first_from(200)->translation().x(), 200, 1e-9);
}

}  // namespace
}  // namespace planemap::odometry
