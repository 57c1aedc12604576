// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/bad_moments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/choices.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench_odometry {
namespace {

Told run(const std::string& name, const std::string& moment, const Undisturbed& part) {
    auto source = std::make_unique<simulator::SimulatedSource>(simulator::parse_simulator_name(name));
    const Trajectory truth = source->ground_truth();
    pipeline::PipelineOptions options;
    options.with_graph = options.with_map = options.with_octomap = false;
    const Script script = benchmark::named("moments", moment, known_disturbances()).script(part);
    return run_script(std::move(source), script, truth, options, [](std::int64_t) {});
}

constexpr const char* kOffice = "sim:office?width=320&height=240&frames=60";

TEST(RunScript, TellsOfEveryFrame) {
    const Told told = run(kOffice, "none", {30, 10, 30});
    ASSERT_EQ(told.frames.size(), 30u);
    ASSERT_FALSE(told.keyframes.empty());
    EXPECT_EQ(told.keyframes[0].frame, 0u);
    EXPECT_EQ(told.find(0), &told.keyframes[0]);
    EXPECT_EQ(told.find(1000), nullptr);
    const MomentRow row = make_row(told, 10);
    EXPECT_EQ(row.frames, 20);
    EXPECT_EQ(row.wrong + row.no_pose + row.degenerate + row.stale + row.unjudged + row.parts, 0);
    EXPECT_LT(row.worst_m, 0.03);
    EXPECT_EQ(row.nees_count, 20);
}

TEST(RunScript, FramesThatShowNothingHaveNoPose) {
    const MomentRow row = make_row(run(kOffice, "covered-1s", {50, 10, 30}), 10);
    EXPECT_EQ(row.frames, 40);
    EXPECT_GE(row.no_pose, 25);
    EXPECT_EQ(row.wrong, 0);
}

TEST(RunScript, ASourceThatIsTooShortIsSaid) {
    EXPECT_THAT(error_of([] {
                    run("sim:office?width=64&height=48&frames=5", "none", {9, 3, 30});
                }),
                testing::HasSubstr("5 of 9"));
}

TEST(BadSequences, LetEveryMomentBeShown) {
    for (const BadSequence& bad : bad_sequences()) {
        if (bad.walk > 0) {
            EXPECT_LT(bad.walk + 12, bad.frames) << bad.sequence.name;
            continue;
        }
        EXPECT_GE(bad.first, kFramesBefore) << bad.sequence.name;
        EXPECT_LT(bad.first, bad.frames) << bad.sequence.name;
        if (!bad.moments.empty()) {
            EXPECT_NO_THROW(benchmark::chosen("moments", bad.moments, known_disturbances()));
        }
    }
}

/// A walk of ten frames along x with a keyframe each, and after it returns of two frames each.
struct Returned {
    Told told;
    Returned() {
        for (int i = 0; i < 10; ++i) add(i, true);
    }
    void add(double x, bool is_tracked) {
        const Pose pose(Eigen::Translation3d(x, 0, 0));
        told.frames.push_back({{}, pose});
        if (!is_tracked) return;
        const int id = static_cast<int>(told.keyframes.size());
        told.keyframes.push_back({id, id - 1, told.frames.size() - 1, pose, Matrix6d::Zero()});
    }
    /// The last frame says that it is so far from a keyframe.
    void place(int id, double x) {
        OdometryEstimate& estimate = told.frames.back().estimate;
        estimate.status = TrackingStatus::kTracked;
        estimate.keyframe_id = id;
        estimate.keyframe_from_camera = Pose(Eigen::Translation3d(x, 0, 0));
    }
};

TEST(ReturnsRow, CountsWhatIsPlacedRightAndWrong) {
    Returned walk;
    walk.add(3.2, false);  // lost
    walk.add(3.2, false);
    walk.add(3.2, false);  // found by its second frame
    walk.add(3.3, false);
    walk.place(3, 0.3);
    walk.add(5.0, false);  // found where it is not
    walk.place(3, 0.1);
    walk.add(5.0, false);
    walk.place(5, 0);
    walk.add(7.1, true);  // a keyframe of its own, which a loop closure ties
    walk.add(7.2, false);
    walk.place(10, 0.1);
    walk.told.closures.push_back({7, 10, Pose(Eigen::Translation3d(0.1, 0, 0))});
    walk.add(8.1, true);  // and one that is false
    walk.add(8.2, false);
    walk.told.closures.push_back({2, 11, Pose(Eigen::Translation3d(0.1, 0, 0))});
    const ReturnsRow row = make_returns_row(walk.told, 10, 5, 2);
    EXPECT_EQ(row.cuts, 5);
    EXPECT_EQ(row.found, 2);
    EXPECT_EQ(row.wrong, 2);
}

TEST(ReturnsRow, APoseAgainstItsOwnKeyframeIsNotFound) {
    Returned walk;
    walk.add(4, true);
    walk.place(10, 0);
    walk.add(4.1, false);
    walk.place(10, 0.1);
    const ReturnsRow row = make_returns_row(walk.told, 10, 1, 2);
    EXPECT_EQ(row.found, 0);
    EXPECT_EQ(row.wrong, 0);
}

}  // namespace
}  // namespace planemap::bench_odometry
