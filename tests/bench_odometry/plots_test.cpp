// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/plots.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluate/walks.hpp"

namespace planemap::bench_odometry {
namespace {

using test::circle;
using test::moved;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A camera on a circle that holds its head upright in a world whose `up` is a column of `world`.
Trajectory upright(double pitch) {
    Trajectory path = circle(1);
    Eigen::Matrix3d forward_along_y;
    forward_along_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    for (StampedPose& pose : path)
        pose.world_from_camera.linear() =
            pose.world_from_camera.linear() * forward_along_y * so3_exp(Eigen::Vector3d(pitch, 0, 0));
    return path;
}

TEST(UpDirection, IsTheAxisThatTheCamerasAgreeOn) {
    EXPECT_EQ(up_direction(upright(0)), Eigen::Vector3d::UnitZ());
    EXPECT_EQ(up_direction(upright(0.4)), Eigen::Vector3d::UnitZ());
    Twist twist = Twist::Zero();
    twist[3] = 3.14159265358979 / 2;
    EXPECT_EQ(up_direction(moved(upright(0), pose_from_twist(twist))), -Eigen::Vector3d::UnitY());
    twist[3] = 0.75;
    EXPECT_NEAR(up_direction(moved(upright(0), pose_from_twist(twist)))
                    .dot(so3_exp({0.75, 0, 0}) * Eigen::Vector3d::UnitZ()),
                1, 1e-6);
    EXPECT_EQ(up_direction({}), Eigen::Vector3d::UnitZ());
}

TEST(Plot, ShowsTruthRowsLegendAndScale) {
    const Trajectory truth = upright(0);
    MethodRun run;
    run.trajectory = truth;
    run.trajectory.erase(run.trajectory.begin() + 100, run.trajectory.begin() + 160);
    const Row row = make_row("sim:kt0", "default", truth, run);
    const std::string svg = plot_svg("sim:kt0", truth, {row, make_row("sim:kt0", "paper", truth, {})});
    EXPECT_THAT(svg, AllOf(HasSubstr("sim:kt0, from above"), HasSubstr("truth"), HasSubstr("default, 0.0 cm"),
                           HasSubstr("0.5 m"), Not(HasSubstr("paper")), Not(HasSubstr("nan"))));
    Trajectory longer = truth;
    longer.push_back({truth.back().utime + 1000000, Pose(Eigen::Translation3d(90, 0, 0))});
    EXPECT_EQ(plot_svg("sim:kt0", longer, {row}), plot_svg("sim:kt0", truth, {row})) << "truth in time only";
    EXPECT_THAT(plot_svg("empty", truth, {}), AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
    int moves = 0;
    for (const char c : svg) moves += c == 'M' ? 1 : 0;
    EXPECT_EQ(moves, 3) << "the truth, and two pieces";
}

}  // namespace
}  // namespace planemap::bench_odometry
