// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-soak: a day's walk in one place, and the memory that it takes.
#include "bench_soak/soak.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scratch_folder.hpp"
#include "messages/process.hpp"

namespace planemap::bench_soak {
namespace {

constexpr double kMostGrowth = 0.1;
constexpr int kADay = 86400;  // frames, a second apart

struct Arguments : benchmark::Options {
    bool simulated = false;  // what tools/soak is called with
    std::string world;
    SoakOptions soak;
};

std::string description() {
    return "A walk that goes on for a day: renders one round of a simulated walk, and feeds it again and "
           "again\n"
           "through the modules of planemap-run, with stamps that go on. Prints keyframes, memory and time "
           "as\n"
           "they develop, and whether memory stays within 10 % of what it is after the first half hour.\n"
           "Exit code: 0 when it does, 1 when not.\n"
           "Sequences: sim:... whose walk goes round (see planemap-simulate --help).\n"
           "Columns: frames and lost ones; keyframes that odometry made, that graph and map keep; loop "
           "closures;\n"
           "planes; memory of the process, of graph and map; CPU time a frame; the largest error of a pose.\n"
           "Example: tools/soak --simulated --frames 10000 --every 500";
}

void add_flags(messages::Flags& flags, Arguments& arguments) {
    pipeline::PipelineOptions& pipeline = arguments.soak.pipeline;
    benchmark::add_flags(flags, arguments, "frames in all; 0: a day of them, 86,400");
    flags.add("simulated", arguments.simulated, "walk through the simulator: as without");
    flags.add("world", arguments.world, "one more name of --sequences, before which it goes");
    flags.add("every", arguments.soak.every, "frames a line");
    flags.add("period-s", arguments.soak.period_s, "seconds between the stamps of two frames");
    flags.add("octomap", pipeline.with_octomap, "build the OctoMap to compare with, too");
    flags.add(options_of(pipeline.odometry), "odometry-");
    flags.add(options_of(pipeline.graph), "graph-");
    flags.add(options_of(pipeline.map.map), "map-");
}

std::string verdict(const std::optional<double>& growth) {
    if (!growth) return "memory after the first half hour: not measured, the walk was not longer than that\n";
    return results::text(
        "memory at the end: %+.1f %% of that after the first half hour (at most %.0f %%): %s\n",
        100 * *growth, 100 * kMostGrowth, *growth <= kMostGrowth ? "holds" : "DOES NOT HOLD");
}

/// Walks through one world; returns whether memory grew by too much.
bool grows(const benchmark::SequenceInfo& sequence, const Arguments& arguments, benchmark::Report& report) {
    const benchmark::ScratchFolder folder("planemap-soak");
    const Round round = render_round(benchmark::input_of(sequence, arguments.data), folder.path());
    SoakOptions options = arguments.soak;
    options.frames = arguments.frames > 0 ? arguments.frames : kADay;
    report.print(results::text("%s: a round of %zu frames, again and again, %g s apart by their stamps\n",
                               sequence.name.c_str(), round.world_from_camera.size(), options.period_s));
    report.print(table().heading());
    const auto say = benchmark::frame_counter(sequence.name, arguments.quiet);
    const std::vector<Json> points = soak(round, options, say, [&](const Json& point) {
        report.print(table().line(point));
        return !messages::stop_requested();
    });
    const std::optional<double> growth_of_memory = growth(points, options.period_s);
    report.print(verdict(growth_of_memory));
    report.add(to_json(sequence.name, points, options.period_s));
    return growth_of_memory && *growth_of_memory > kMostGrowth;
}

int run(const Arguments& arguments) {
    messages::catch_stop_signals();
    const std::vector<benchmark::SequenceInfo> sequences =
        benchmark::parse_sequences(arguments.world.empty() ? arguments.sequences : arguments.world, {});
    bool does_hold = true;
    benchmark::run_report(arguments, "none", [&](benchmark::Report& report) {
        report.for_each(sequences, [&](const benchmark::SequenceInfo& sequence) {
            if (messages::stop_requested()) return;
            does_hold = !grows(sequence, arguments, report) && does_hold;
        });
    });
    return does_hold ? 0 : 1;
}

}  // namespace
}  // namespace planemap::bench_soak

int main(int argc, char** argv) {
    using namespace planemap::bench_soak;
    Arguments arguments;
    arguments.sequences = "sim:office?width=320&height=240";
    arguments.soak.pipeline.with_octomap = false;
    return planemap::benchmark::run_program("planemap-bench-soak", description(), argc, argv, arguments,
                                            add_flags, run);
}
