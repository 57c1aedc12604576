// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/pose_noise.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"

namespace planemap::bench_map {
namespace {

Trajectory minutes() {
    Trajectory path;
    for (int i = 0; i < 6000; ++i)
        path.push_back({1000 + i * 33333, make_pose({0.01 * i, 0, 0}, Eigen::Quaterniond::Identity())});
    return path;
}

TEST(PoseNoise, IsAsLargeAsAskedAndSmooth) {
    const Trajectory path = minutes(), noisy = with_noise(path, {0.02, 0.5}, 1);
    ASSERT_EQ(noisy.size(), path.size());
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    double angles = 0, step = 0;
    Pose last = Pose::Identity();
    for (std::size_t i = 0; i < path.size(); ++i) {
        EXPECT_EQ(noisy[i].utime, path[i].utime);
        const Pose error = path[i].world_from_camera.inverse(Eigen::Isometry) * noisy[i].world_from_camera;
        squares += error.translation().cwiseAbs2();
        angles += std::pow(degrees(rotation_angle(error)), 2);
        if (i > 0) step = std::max(step, (error.translation() - last.translation()).norm());
        last = error;
    }
    const auto n = static_cast<double>(path.size());
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(squares[axis] / n), 0.02, 0.004);
    EXPECT_NEAR(std::sqrt(angles / n / 3), 0.5, 0.1);
    EXPECT_LT(step, 0.006);
}

TEST(PoseNoise, IsTheSameForTheSameSeedAlone) {
    const Trajectory a = with_noise(minutes(), {0.02, 0.5}, 1), b = with_noise(minutes(), {0.02, 0.5}, 1),
                     c = with_noise(minutes(), {0.02, 0.5}, 2);
    EXPECT_EQ(a[500].world_from_camera.matrix(), b[500].world_from_camera.matrix());
    EXPECT_NE(a[500].world_from_camera.matrix(), c[500].world_from_camera.matrix());
    const Trajectory none = with_noise(minutes(), {}, 1);
    EXPECT_TRUE(none[500].world_from_camera.isApprox(minutes()[500].world_from_camera));
    EXPECT_TRUE(with_noise({}, {0.02, 0.5}, 1).empty());
}

}  // namespace
}  // namespace planemap::bench_map
