// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/run.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluate/walks.hpp"

namespace planemap::bench_odometry {
namespace {

using test::circle;

TEST(Run, ComesThroughJsonExactly) {
    MethodRun run;
    run.frames = 40;
    run.trajectory = circle(0.1);
    run.tracking = {1.25, 2.5, 0.1, 30};
    run.graph = {5, 6, 0.2, 3};
    run.keyframes = 3;
    run.closures = {{1, 2, run.trajectory[7].world_from_camera}};
    run.relatives = {{3, 4, run.trajectory[5].world_from_camera, Matrix6d::Identity() / 3}};
    run.relatives[0].covariance(1, 4) = 0.1;
    const MethodRun same = run_from_json(nlohmann::json::parse(to_json(run).dump()));
    EXPECT_EQ(same.frames, run.frames);
    EXPECT_EQ(same.keyframes, 3);
    EXPECT_EQ(same.tracking.p95_ms, 2.5);
    EXPECT_EQ(same.graph.count, 3);
    ASSERT_EQ(same.trajectory.size(), run.trajectory.size());
    for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
        EXPECT_EQ(same.trajectory[i].utime, run.trajectory[i].utime);
        EXPECT_EQ(same.trajectory[i].world_from_camera.matrix(),
                  run.trajectory[i].world_from_camera.matrix());
    }
    ASSERT_EQ(same.closures.size(), 1u);
    EXPECT_EQ(same.closures[0].to_utime, 2);
    EXPECT_EQ(same.closures[0].from_from_to.matrix(), run.closures[0].from_from_to.matrix());
    ASSERT_EQ(same.relatives.size(), 1u);
    EXPECT_EQ(same.relatives[0].keyframe_utime, 3);
    EXPECT_EQ(same.relatives[0].utime, 4);
    EXPECT_EQ(same.relatives[0].covariance, run.relatives[0].covariance);
}

TEST(StageTime, IsZeroForAStageThatNeverRan) {
    EXPECT_EQ(stage_time(Histogram()).count, 0);
    Histogram ms;
    for (int i = 1; i <= 100; ++i) ms.add(i);
    const StageTime time = stage_time(ms);
    EXPECT_NEAR(time.median_ms, 50, 2);
    EXPECT_NEAR(time.p95_ms, 95, 3);
    EXPECT_NEAR(time.total_s, 5.05, 1e-9);
}

}  // namespace
}  // namespace planemap::bench_odometry
