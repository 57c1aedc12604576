// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/benchmark.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/choices.hpp"
#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench_odometry {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Benchmark, RunsMethodsOnARenderedSequence) {
    const TemporaryFolder folder;
    BenchmarkOptions options;
    options.cache = folder.path();
    options.frames = 15;
    options.slow_frames = 8;
    options.quiet = true;
    const Benchmark runner(options);
    const Sequence sequence = runner.open({"sim:tiny", "", "office?width=320&height=240", "", 0});
    for (const MethodInfo& method : parse_methods("default,opencv-rgbdicp")) {
        const Row row = runner.run(sequence, method);
        EXPECT_EQ(row.method, method.name);
        EXPECT_EQ(row.run.frames, method.slow ? 8 : 15);
        EXPECT_EQ(row.lost(), 0);
        ASSERT_TRUE(row.evaluation && row.evaluation->ate);
        EXPECT_LT(row.evaluation->ate->metres.rmse, 0.03);
        EXPECT_GT(row.cpu_s, 0);
        EXPECT_GT(row.peak_rss_mb, 5);
    }
}

TEST(Benchmark, KnowsSequencesThatCanBeRead) {
    for (const SequenceInfo& info : known_sequences()) {
        const std::string name = "sim:" + (info.simulator.empty() ? "office" : info.simulator);
        EXPECT_NO_THROW(simulator::parse_simulator_name(name)) << info.name;
    }
    BenchmarkOptions options;
    options.data = "/no/such/data";
    const Benchmark runner(options);
    for (const char* name : {"redkitchen", "sim:kt2"}) {
        const SequenceInfo info = benchmark::named("sequences", name, known_sequences());
        EXPECT_THAT(error_of([&] { runner.open(info); }), HasSubstr("/no/such/data/"));
    }
}

TEST(Benchmark, ErrorsNameMethodSequenceAndReason) {
    const Benchmark runner({});
    EXPECT_THAT(error_of([&] {
                    runner.run({"kitchen", "/no/such/folder", std::nullopt}, known_methods().at(0));
                }),
                AllOf(HasSubstr("default on kitchen"), HasSubstr("/no/such/folder")));
    BenchmarkOptions bad;
    bad.frames = -1;
    bad.slow_frames = -2;
    EXPECT_THAT(error_of([&] { Benchmark{bad}; }), AllOf(HasSubstr("frames"), HasSubstr("slow-frames")));
}

}  // namespace
}  // namespace planemap::bench_odometry
