// SPDX-License-Identifier: BSD-3-Clause
#include "run/outputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/input.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// An input without frames; the simulator's knows the truth.
struct NoFrames : Input {
    explicit NoFrames(bool simulated) : is_of_simulator(simulated) {}
    std::int64_t frames() const override { return 0; }
    std::optional<double> progress() const override { return std::nullopt; }
    std::vector<std::string> complaints() const override { return {}; }
    std::vector<Result> truth_results() const override {
        if (!is_of_simulator) return {};
        return {{"groundtruth.txt", [](const auto&) {}}, {"planes_truth.json", [](const auto&) {}}};
    }
    messages::Spent read_next() override { return {}; }
    bool publish_next() override { return false; }
    bool is_of_simulator;
};

TEST(ResultNames, TheTruthIsOursOnlyOfASimulatedRun) {
    const TemporaryFolder folder;
    const NoFrames recorded(false), simulated(true);
    EXPECT_THAT(result_names(folder.path(), recorded),
                AllOf(Contains("plane_map.lcmlog"), Contains("report.json"), Contains("octomap.bt"),
                      Contains("points.ply"), Not(Contains("groundtruth.txt"))));
    EXPECT_THAT(result_names(folder.path(), simulated),
                AllOf(Contains("groundtruth.txt"), Contains("planes_truth.json")));
    folder.write("report.json", R"({"input": "sim:office"})");
    folder.write("groundtruth.txt", "of the run before");
    EXPECT_THAT(result_names(folder.path(), recorded), Contains("groundtruth.txt"))
        << "removed with the run that it is of";
}

TEST(ResultNames, ARecordingsTruthIsNotWrittenOver) {
    const TemporaryFolder folder;
    const auto file = folder.write("groundtruth.txt", "a recording's");
    EXPECT_THAT(error_of([&] { result_names(folder.path(), NoFrames(true)); }), HasSubstr(file.string()));
    folder.write("report.json", R"({"input": "kitchen"})");
    EXPECT_THAT(error_of([&] { result_names(folder.path(), NoFrames(true)); }), HasSubstr(file.string()));
    folder.write("report.json", "{");
    EXPECT_THAT(error_of([&] { result_names(folder.path(), NoFrames(true)); }), HasSubstr(file.string()));
    EXPECT_THAT(result_names(folder.path(), NoFrames(false)), Not(Contains("groundtruth.txt")));
}

TEST(RunClock, CountsUntilItIsStopped) {
    RunClock clock;
    EXPECT_EQ(clock.wall_s(), 0);
    clock.stop();
    const double wall_s = clock.wall_s();
    EXPECT_GE(wall_s, 0);
    EXPECT_GE(clock.cpu_s(), 0);
    EXPECT_EQ(clock.wall_s(), wall_s);
}

}  // namespace
}  // namespace planemap
