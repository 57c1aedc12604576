// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/row.hpp"

#include <gtest/gtest.h>

#include "evaluate/walks.hpp"
#include "results/rows.hpp"

namespace planemap::bench_odometry {
namespace {

using test::circle;

/// A run with a perfect trajectory but for its size, ten frames lost, and one closure each, true and false.
MethodRun run_of(const Trajectory& truth, double size) {
    MethodRun run;
    run.frames = static_cast<std::int64_t>(truth.size()) + 10;
    run.trajectory = truth;
    for (StampedPose& pose : run.trajectory) pose.world_from_camera.translation() *= size;
    run.tracking = {1.5, 3.5, 1.0, run.frames};
    run.segmentation = {2, 3, 1.0, run.frames};
    run.keyframes = 7;
    const Pose apart = truth[0].world_from_camera.inverse() * truth[30].world_from_camera;
    run.closures = {{truth[0].utime, truth[30].utime, apart},
                    {truth[0].utime, truth[30].utime, Pose::Identity()}};
    return run;
}

TEST(Row, ComparesWithTheTruth) {
    const Trajectory truth = circle(1);
    const Row row = make_row("sim:kt0", "default", truth, run_of(truth, 1.02));
    const Json json = to_json(row);
    EXPECT_EQ(json["sequence"], "sim:kt0");
    EXPECT_EQ(json["method"], "default");
    EXPECT_EQ(json["frames"], 310);
    EXPECT_EQ(json["lost"], 10);
    EXPECT_NEAR(json["ate_m"], 0.04, 1e-3);
    EXPECT_NEAR(json["scale"], 1 / 1.02, 1e-6);
    EXPECT_NEAR(json["rpe_frame_deg"], 0, 1e-5);
    EXPECT_NEAR(json["rpe_1s_m"], 0.02 * 2 * 2 * std::sin(3.14159265 / 10), 1e-4);
    EXPECT_EQ(json["loops_true"], 1);
    EXPECT_EQ(json["loops_false"], 1);
    ASSERT_EQ(json["false_loops"].size(), 1u);
    EXPECT_EQ(json["false_loops"][0]["to_utime"], truth[30].utime);
    EXPECT_EQ(json["median_ms"], 1.5);
    EXPECT_EQ(json["keyframes"], 7);
}

TEST(Row, HoldsErrorsAgainstTheirCovariance) {
    const Trajectory truth = circle(1);
    MethodRun run = run_of(truth, 1);
    for (std::size_t i = 1; i < 5; ++i) {
        Relative relative{truth[0].utime, truth[i].utime,
                          truth[0].world_from_camera.inverse() * truth[i].world_from_camera,
                          1e-4 * Matrix6d::Identity()};
        relative.keyframe_from_camera.translation().x() += 0.01 * static_cast<double>(i);  // i sigma
        run.relatives.push_back(relative);
    }
    EXPECT_EQ(to_json(make_row("a", "b", truth, run))["nees_share"], 0.75);
    run.relatives[3].utime += 1000000000;  // no truth there
    EXPECT_EQ(to_json(make_row("a", "b", truth, run))["nees_share"], 1);
    results::expect_null(to_json(make_row("a", "b", std::nullopt, run)), {"nees_share"});
    results::expect_null(to_json(make_row("a", "b", truth, run_of(truth, 1))), {"nees_share"});
}

TEST(Row, WhatIsNotKnownIsNull) {
    const Trajectory truth = circle(1);
    const Json without = to_json(make_row("a", "b", std::nullopt, run_of(truth, 1)));
    results::expect_null(without,
                         {"ate_m", "scale", "rpe_frame_m", "rpe_1s_deg", "loops_true", "loops_false"});
    EXPECT_EQ(without["loops_unjudged"], 2);
    results::expect_null(to_json(make_row("a", "b", truth, {})), {"ate_m", "rpe_frame_m", "median_ms"});
}

TEST(Row, LinesOfTheTableAreAligned) {
    const Trajectory truth = circle(1);
    results::expect_aligned(table(), {to_json(make_row("a", "opencv-rgbdicp", truth, run_of(truth, 1.02))),
                                      to_json(make_row("a", "paper", std::nullopt, run_of(truth, 1))),
                                      to_json(make_row("a", "default-no-graph", truth, {}))});
}

}  // namespace
}  // namespace planemap::bench_odometry
