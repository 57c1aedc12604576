// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/methods.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluate/evaluation.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench_odometry {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(ParseMethods, NamesWhatThereIs) {
    EXPECT_EQ(parse_methods("paper,default").at(1).name, "default");
    EXPECT_TRUE(parse_methods("opencv-rgbd").at(0).slow);
    EXPECT_THAT(error_of([] { parse_methods("default,orb"); }),
                AllOf(HasSubstr("\"orb\""), HasSubstr("default-no-graph"), HasSubstr("opencv-rgbdicp")));
    EXPECT_NE(error_of([] { parse_methods(""); }), "");
}

TEST(RunMethod, EveryMethodFollowsAnEasyWalk) {
    const std::string input = "sim:office?width=320&height=240&frames=20";
    const Trajectory truth =
        simulator::SimulatedSource(simulator::parse_simulator_name(input)).ground_truth();
    for (const MethodInfo& method : known_methods()) {
        std::int64_t seen = 0;
        const MethodRun run =
            run_method(method.name, input, 12, {}, [&](std::int64_t frames) { seen = frames; });
        EXPECT_EQ(run.frames, 12) << method.name;
        EXPECT_EQ(seen, 12) << method.name;
        ASSERT_GE(run.trajectory.size(), 10u) << method.name;
        EXPECT_EQ(run.trajectory.back().utime, truth[11].utime) << method.name;
        EXPECT_GT(run.tracking.count, 9) << method.name;
        EXPECT_GT(run.tracking.median_ms, 0) << method.name;
        EXPECT_EQ(run.keyframes > 0, method.name == "default" || method.name == "paper") << method.name;
        const Evaluation evaluation = evaluate(truth, run.trajectory, {});
        ASSERT_TRUE(evaluation.rpe_frame) << method.name;
        EXPECT_LT(evaluation.rpe_frame->metres.rmse, 0.02) << method.name;
        EXPECT_LT(evaluation.rpe_frame->degrees.rmse, 1) << method.name;
    }
}

TEST(RunMethod, MissingInputIsNamed) {
    for (const char* method : {"default", "opencv-rgbd"}) {
        EXPECT_THAT(error_of([&] { run_method(method, "/no/such/folder", 0, {}, [](std::int64_t) {}); }),
                    HasSubstr("/no/such/folder"));
    }
}

}  // namespace
}  // namespace planemap::bench_odometry
