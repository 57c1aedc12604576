// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/closures.hpp"

#include <gtest/gtest.h>

#include "bench_odometry/walks.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::bench_odometry {
namespace {

using Eigen::Vector3d;

/// The true closure between two poses of a path, off by metres along x and degrees about z.
Closure closure(const Trajectory& truth, std::size_t from, std::size_t to, double metres, double degrees) {
    Pose error = Pose::Identity();
    error.translation() = metres * Vector3d::UnitX();
    error.linear() = Eigen::AngleAxisd(radians(degrees), Vector3d::UnitZ()).toRotationMatrix();
    const Pose relative = truth[from].world_from_camera.inverse() * truth[to].world_from_camera;
    return {truth[from].utime, truth[to].utime, relative * error};
}

TEST(Judge, TrueWithinTenCentimetresAndFiveDegrees) {
    const Trajectory truth = circle(2);
    EXPECT_FALSE(judge(truth, closure(truth, 0, 300, 0, 0))->is_false);
    EXPECT_FALSE(judge(truth, closure(truth, 3, 303, 0.09, 4.9))->is_false);
    EXPECT_TRUE(judge(truth, closure(truth, 0, 300, 0.11, 0))->is_false);
    EXPECT_TRUE(judge(truth, closure(truth, 0, 300, 0, 5.1))->is_false);
    const auto error = judge(truth, closure(truth, 20, 90, 0.3, 7));
    EXPECT_NEAR(error->metres, 0.3, 1e-9);
    EXPECT_NEAR(error->degrees, 7, 1e-6);
}

TEST(Judge, AllowsMoreOverALongerDistance) {
    const Trajectory truth = circle(1);
    // Half a circle apart: 4 m, so 10 + 8 cm.
    EXPECT_FALSE(judge(truth, closure(truth, 0, 150, 0.17, 0))->is_false);
    EXPECT_TRUE(judge(truth, closure(truth, 0, 150, 0.19, 0))->is_false);
}

TEST(Judge, DoesNotDependOnTheWorldFrame) {
    const Trajectory truth = circle(1);
    Twist twist;
    twist << 3, -2, 1, 0.4, 1.2, -0.7;
    const Trajectory elsewhere = moved(truth, pose_from_twist(twist));
    for (const double metres : {0.05, 0.5}) {
        const Closure c = closure(truth, 10, 40, metres, 1);
        EXPECT_NEAR(judge(truth, c)->metres, judge(elsewhere, c)->metres, 1e-9);
        EXPECT_NEAR(judge(truth, c)->degrees, judge(elsewhere, c)->degrees, 1e-6);
    }
}

TEST(Judge, SaysNothingWithoutTruth) {
    const Trajectory truth = circle(1);
    Closure early = closure(truth, 0, 100, 0, 0);
    early.from_utime = 0;
    EXPECT_FALSE(judge(truth, early));
    EXPECT_FALSE(judge({}, closure(truth, 0, 100, 0, 0)));
}

}  // namespace
}  // namespace planemap::bench_odometry
