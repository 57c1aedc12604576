// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/run.hpp"

#include <gtest/gtest.h>

#include "bench_map/true_poses.hpp"
#include "evaluate/true_planes.hpp"

namespace planemap::bench_map {
namespace {

constexpr const char* kOffice = "sim:office?width=320&height=240&noise=0&frames=40";

TEST(RunSequence, MapsBothKindsOfPoses) {
    RunOptions options;
    options.frames = 30;
    std::int64_t seen = 0;
    const SequenceRun run = run_sequence(kOffice, options, [&](std::int64_t frames) { seen = frames; });
    EXPECT_EQ(run.frames, 30);
    EXPECT_EQ(seen, 30);
    ASSERT_TRUE(run.true_poses && run.truth);
    EXPECT_EQ(run.true_poses->poses.keyframes.size(), run.keyframes.size());
    const auto truth = evaluation::true_planes(kOffice, 30).value();
    const auto truth_from_map = alignment(run.true_poses->poses, run.estimated.poses);
    ASSERT_TRUE(truth_from_map);
    for (const auto& [map_run, pose] :
         {std::pair{&run.estimated, *truth_from_map}, std::pair{&*run.true_poses, Pose::Identity()}}) {
        EXPECT_GT(map_run->message_bytes, 100u);
        EXPECT_GT(map_run->memory_bytes, 100u);
        EXPECT_GT(map_run->rebuild_ms, 0);
        ASSERT_TRUE(map_run->coverage);
        EXPECT_GT(map_run->coverage->area_supported, 0.3);
        EXPECT_GT(judge(truth, map_run->map, pose).found(), 0u);
        const Pose elsewhere = make_pose({1.3, 0.4, 0.2}, Eigen::Quaterniond::Identity()) * pose;
        EXPECT_LT(judge(truth, map_run->map, elsewhere).found(), judge(truth, map_run->map, pose).found());
    }
}

TEST(RunSequence, LeavesOutWhatIsNotWanted) {
    RunOptions options;
    options.frames = 3;
    options.true_poses = false;
    options.pipeline.with_octomap = false;
    const SequenceRun run = run_sequence(kOffice, options, [](std::int64_t) {});
    EXPECT_FALSE(run.true_poses);
    EXPECT_FALSE(run.estimated.coverage);
    EXPECT_FALSE(run.keyframes.empty());
}

TEST(MapAt, KeyframesWithoutAPoseAreLeftOut) {
    EXPECT_TRUE(map_at({}, {}, {}).map.planes.empty());
    Keyframe keyframe;
    keyframe.id = 1;
    EXPECT_TRUE(map_at({keyframe}, {}, {}).map.planes.empty());
}

}  // namespace
}  // namespace planemap::bench_map
