// SPDX-License-Identifier: BSD-3-Clause
#include "map/told_up.hpp"

#include <gtest/gtest.h>

#include "core/furniture.hpp"

namespace planemap::map {
namespace {

using Eigen::Vector3d;

/// Poses of a camera that looks around, by keyframe.
std::map<int, Pose> poses() {
    std::map<int, Pose> poses;
    for (const Pose& pose : scene::looking_around(1.4, 0.3)) poses[static_cast<int>(poses.size())] = pose;
    return poses;
}

double error(const Up& up) {
    return up.direction ? (*up.direction - Vector3d::UnitZ()).norm() : 9;
}

/// Up in the camera of a pose.
Vector3d seen_from(const Pose& pose) {
    return pose.linear().transpose() * Vector3d::UnitZ();
}

TEST(ToldUp, SaysNothingUntilItIsTold) {
    const Up up = ToldUp().find(poses(), {}, {});
    EXPECT_FALSE(up.direction);
    EXPECT_EQ(up.why, "");
}

TEST(ToldUp, ByTheMount) {
    ToldUp told;
    Pose body_from_camera = Pose::Identity();
    body_from_camera.linear() << 0, -0.3, 0.954, -1, 0, 0, 0, -0.954, -0.3;
    body_from_camera.linear() = Eigen::Quaterniond(body_from_camera.linear()).normalized().toRotationMatrix();
    std::map<int, Pose> world_from_camera;
    for (int i = 0; i < 8; ++i)
        world_from_camera[i] = Eigen::AngleAxisd(i, Vector3d::UnitZ()) * body_from_camera;
    told.hear_mount(body_from_camera);
    EXPECT_EQ(told.revision(), 1);
    told.hear_mount(body_from_camera);
    EXPECT_EQ(told.revision(), 1) << "nothing new";
    const Up up = told.find(world_from_camera, {}, {});
    EXPECT_LT(error(up), 1e-6);
    EXPECT_EQ(up.why, "by camera.json's body_from_camera");
}

TEST(ToldUp, ByAnAccelerometerThatShakes) {
    ToldUp told;
    const std::map<int, Pose> keyframes = poses();
    for (const auto& [id, pose] : keyframes) {
        const std::int64_t utime = 1000000 * id;
        for (int i = -20; i <= 0; ++i)
            told.hear({utime + 10000 * i, 9.8 * seen_from(pose) + Vector3d((i % 2) * 2 + 1, 0.5, -0.5)});
        told.came(id, utime);
    }
    const Up up = told.find(keyframes, {}, {});
    EXPECT_LT(error(up), 0.1);
    EXPECT_EQ(up.why, "by the accelerometer");
}

TEST(ToldUp, AnAccelerometerInOtherAxesIsNotBelieved) {
    ToldUp told;
    const std::map<int, Pose> keyframes = poses();
    for (const auto& [id, pose] : keyframes) {
        const Vector3d up_camera = seen_from(pose);
        told.hear({1000000 * id, 9.8 * Vector3d(up_camera.y(), up_camera.z(), up_camera.x())});
        told.came(id, 1000000 * id);
    }
    const Up up = told.find(keyframes, {}, {});
    EXPECT_FALSE(up.direction);
    EXPECT_NE(up.why.find("the accelerometer says another direction each time"), std::string::npos) << up.why;
}

TEST(ToldUp, ReadingsThatAreNoneOrOfAnotherTimeDoNotCount) {
    ToldUp told;
    const Pose pose = poses().at(0);
    told.hear({0, Vector3d(0, std::nan(""), 0)});
    told.hear({0, Vector3d(0, 50, 0)});
    told.hear({0, Vector3d(0, 1, 0)});
    told.hear({900000, Vector3d(0, 9.8, 0)});
    told.came(0, 0);
    EXPECT_FALSE(told.find({{0, pose}}, {}, {}).direction);
    EXPECT_EQ(told.revision(), 0);
}

}  // namespace
}  // namespace planemap::map
