// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-soak: a day's walk in one place, and the memory that it takes.
#include <cstdio>

#include "bench_soak/soak.hpp"
#include "benchmark/program.hpp"
#include "benchmark/scratch_folder.hpp"
#include "core/standard_output.hpp"

namespace planemap {
namespace {

constexpr double kMostGrowth = 0.1;

struct Options {
    bool simulated = false;
    std::string world = "sim:office?width=320&height=240";
    bench_soak::SoakOptions soak;
};

int run(const Options& options) {
    messages::catch_stop_signals();
    const benchmark::ScratchFolder folder("planemap-soak");
    const bench_soak::Round round = bench_soak::render_round(options.world, folder.path());
    std::printf("%s: a round of %zu frames, again and again, %g s apart by their stamps\n%s",
                options.world.c_str(), round.world_from_camera.size(), options.soak.period_s,
                bench_soak::table().heading().c_str());
    const auto points = bench_soak::soak(round, options.soak, [](const benchmark::Json& point) {
        print(bench_soak::table().line(point));
        finish_printing();
        return !messages::stop_requested();
    });
    const std::optional<double> growth = bench_soak::growth(points, options.soak.period_s);
    if (!growth) {
        std::puts("memory after the first half hour: not measured, the walk was not longer than that");
        return 0;
    }
    std::printf("memory at the end: %+.1f %% of that after the first half hour (at most %.0f %%): %s\n",
                100 * *growth, 100 * kMostGrowth, *growth <= kMostGrowth ? "holds" : "DOES NOT HOLD");
    return *growth <= kMostGrowth ? 0 : 1;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::Options options;
    planemap::pipeline::PipelineOptions& pipeline = options.soak.pipeline;
    pipeline.with_octomap = false;
    const auto add = [&](planemap::messages::Flags& flags) {
        flags.add("simulated", options.simulated, "Walk through the simulator; there is no other way yet");
        flags.add("world", options.world, "Simulator name; its walk must go round");
        flags.add("frames", options.soak.frames, "Frames in all");
        flags.add("every", options.soak.every, "Frames a line");
        flags.add("period-s", options.soak.period_s, "Seconds between the stamps of two frames");
        flags.add("octomap", pipeline.with_octomap, "Build the OctoMap to compare with, too");
        flags.add(options_of(pipeline.odometry), "odometry-");
        flags.add(options_of(pipeline.graph), "graph-");
        flags.add(options_of(pipeline.map.map), "map-");
    };
    return planemap::benchmark::run_program(
        "planemap-bench-soak",
        "A walk that goes on for a day: renders one round of a simulated walk, and feeds it again and again\n"
        "through the modules of planemap-run, with stamps that go on. Prints keyframes, memory and time as\n"
        "they develop, and whether memory stays within 10 % of what it is after the first half hour.\n"
        "Exit code: 0 when it does, 1 when not.\n"
        "Columns: frames and lost ones; keyframes that odometry made, that graph and map keep; loop "
        "closures;\n"
        "planes; memory of the process, of graph and map; CPU time a frame; the largest error of a pose.\n"
        "Example: tools/soak --simulated --frames 10000 --every 500",
        argc, argv, add, [&] {
            if (!options.simulated) throw std::invalid_argument("give --simulated");
            return planemap::run(options);
        });
}
