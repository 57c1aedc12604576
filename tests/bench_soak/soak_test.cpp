// SPDX-License-Identifier: BSD-3-Clause
#include "bench_soak/soak.hpp"

#include <gtest/gtest.h>

#include "results/rows.hpp"
#include "simulate/recording.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench_soak {
namespace {

Json at(std::int64_t frames, double rss_mb) {
    return {{"frames", frames}, {"rss_mb", rss_mb}};
}

TEST(Soak, GrowthIsFromTheFirstHalfHourToTheEnd) {
    EXPECT_FALSE(growth({}, 1));
    EXPECT_FALSE(growth({at(900, 50), at(1800, 60)}, 1));
    EXPECT_NEAR(*growth({at(900, 50), at(1800, 60), at(2700, 70), at(3600, 66)}, 1), 0.1, 1e-9);
    EXPECT_NEAR(*growth({at(900, 50), at(1800, 60)}, 2), 0.2, 1e-9) << "900 frames two seconds apart";
}

TEST(Soak, AWalkIsARow) {
    const Json row = to_json("sim:x", {at(900, 50), at(1800, 60), at(3600, 66)}, 1);
    EXPECT_EQ(row["sequence"], "sim:x");
    EXPECT_EQ(row["points"].size(), 3u);
    EXPECT_NEAR(row["memory_growth"], 0.1, 1e-9);
    EXPECT_TRUE(to_json("sim:x", {at(900, 50)}, 1)["memory_growth"].is_null());
}

TEST(Soak, ARoundGoesOnAndOn) {
    const test::TemporaryFolder folder;
    const std::string name = "sim:office?frames=40&width=160&height=120";
    auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(name));
    Round round{folder.path() / "round.lcmlog", {}};
    for (const StampedPose& pose : source->ground_truth())
        round.world_from_camera.push_back(pose.world_from_camera);
    record(std::move(source), 0, round.log, [](std::int64_t) {});

    SoakOptions options;
    options.frames = 100;
    options.every = 40;
    options.pipeline.with_octomap = false;
    int seen = 0;
    std::int64_t frames_seen = 0;
    const auto points = soak(
        round, options, [&](std::int64_t frames) { frames_seen = frames; },
        [&](const Json&) { return ++seen > 0; });
    ASSERT_EQ(points.size(), 3u);
    EXPECT_EQ(frames_seen, 100);
    EXPECT_EQ(points[0]["frames"], 40);
    EXPECT_EQ(points[2]["frames"], 100);
    EXPECT_LT(points[2]["lost"], 50)
        << "the round does not close: after each, the camera is lost for a while";
    EXPECT_GT(points[0]["keyframes_made"], 0);
    EXPECT_GT(points[0]["planes"], 0);
    EXPECT_GT(points[2]["rss_mb"], 1);
    EXPECT_GT(points[2]["graph_mb"], 0);
    EXPECT_LT(points[2]["off_m"], 0.3);
    results::expect_aligned(table(), points);
    const auto nothing = [](std::int64_t) {};
    EXPECT_EQ(soak(round, options, nothing, [](const Json&) { return false; }).size(), 1u);
    options.every = 0;
    EXPECT_THROW(soak(round, options, nothing, [](const Json&) { return true; }), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::bench_soak
