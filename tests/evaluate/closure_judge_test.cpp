// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/closure_judge.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "evaluate/walks.hpp"

namespace planemap::evaluation {
namespace {

using Eigen::Vector3d;
using test::circle;
using test::moved;

/// The true closure between two poses of a path, off by metres along x and degrees about z.
Closure closure(const Trajectory& truth, std::size_t from, std::size_t to, double metres, double degrees) {
    Pose error = Pose::Identity();
    error.translation() = metres * Vector3d::UnitX();
    error.linear() = Eigen::AngleAxisd(radians(degrees), Vector3d::UnitZ()).toRotationMatrix();
    const Pose relative = truth[from].world_from_camera.inverse() * truth[to].world_from_camera;
    return {truth[from].utime, truth[to].utime, relative * error};
}

TEST(JudgeClosure, TrueWithinTenCentimetresAndFiveDegrees) {
    const Trajectory truth = circle(2);
    EXPECT_FALSE(judge_closure(truth, closure(truth, 0, 300, 0, 0))->is_false);
    EXPECT_FALSE(judge_closure(truth, closure(truth, 3, 303, 0.09, 4.9))->is_false);
    EXPECT_TRUE(judge_closure(truth, closure(truth, 0, 300, 0.11, 0))->is_false);
    EXPECT_TRUE(judge_closure(truth, closure(truth, 0, 300, 0, 5.1))->is_false);
    const auto error = judge_closure(truth, closure(truth, 20, 90, 0.3, 7));
    EXPECT_NEAR(error->metres, 0.3, 1e-9);
    EXPECT_NEAR(error->degrees, 7, 1e-6);
}

TEST(JudgeClosure, AllowsMoreOverALongerDistance) {
    const Trajectory truth = circle(1);
    // Half a circle apart: 4 m, so 10 + 8 cm.
    EXPECT_FALSE(judge_closure(truth, closure(truth, 0, 150, 0.17, 0))->is_false);
    EXPECT_TRUE(judge_closure(truth, closure(truth, 0, 150, 0.19, 0))->is_false);
}

TEST(JudgeClosure, DoesNotDependOnTheWorldFrame) {
    const Trajectory truth = circle(1);
    Twist twist;
    twist << 3, -2, 1, 0.4, 1.2, -0.7;
    const Trajectory elsewhere = moved(truth, pose_from_twist(twist));
    for (const double metres : {0.05, 0.5}) {
        const Closure c = closure(truth, 10, 40, metres, 1);
        EXPECT_NEAR(judge_closure(truth, c)->metres, judge_closure(elsewhere, c)->metres, 1e-9);
        EXPECT_NEAR(judge_closure(truth, c)->degrees, judge_closure(elsewhere, c)->degrees, 1e-6);
    }
}

TEST(JudgeClosure, SaysNothingWithoutTruth) {
    const Trajectory truth = circle(1);
    Closure early = closure(truth, 0, 100, 0, 0);
    early.from_utime = 0;
    EXPECT_FALSE(judge_closure(truth, early));
    EXPECT_FALSE(judge_closure({}, closure(truth, 0, 100, 0, 0)));
}

}  // namespace
}  // namespace planemap::evaluation
