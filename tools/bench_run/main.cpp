// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-run: what a whole run costs.
#include <filesystem>
#include <sstream>

#include "bench_run/ways.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/program.hpp"
#include "benchmark/report.hpp"
#include "benchmark/scratch_folder.hpp"

namespace planemap::bench_run {
namespace {

struct Arguments : benchmark::Options {
    std::string ways = benchmark::names_of(known_ways());
    std::filesystem::path programs;
    int threads = 0;
};

std::string description() {
    std::ostringstream text;
    text
        << "What a whole run costs, from programs that are started as a user starts them: frames a second, "
           "CPU "
           "time, memory.\nR is the unit: what OpenCV's RgbdPlane takes on every 4th pixel of the same "
           "depth. "
           "Beside them stands what\nOctoMap's own insertion takes for a depth image.\nWays:\n"
        << described_ways()
        << "Columns: frames (of processes: those that got a pose); frames a second until the maps are whole "
           "(of "
           "processes: from start to\nend); CPU time of all processes, of which report is the making of the "
           "report; CPU time a frame in ms and in R, and R; the\nsum of each process's most memory. Example: "
           "taskset -c 0 planemap-bench-run --sequences redkitchen";
    return std::move(text).str();
}

void add_flags(messages::Flags& flags, Arguments& arguments) {
    benchmark::add_flags(flags, arguments,
                         "of each sequence, from its start; 0: all. Processes play all of them");
    flags.add("ways", arguments.ways, "comma-separated names, see above");
    flags.add("threads", arguments.threads, "of planemap-run; 0: as many as it takes by itself");
    flags.add("bin", arguments.programs,
              "the folder of planemap-run and the other programs; default: where this program is");
}

int run(const Arguments& arguments) {
    const std::vector<WayInfo> ways = benchmark::chosen("ways", arguments.ways, known_ways());
    const std::vector<benchmark::SequenceInfo> sequences = benchmark::parse_sequences(
        arguments.sequences, benchmark::with_recordings({}), benchmark::Unknown::kIsPath);
    const benchmark::ScratchFolder scratch("planemap-bench-run");
    Bench bench{arguments.programs, arguments.data, scratch.path(), arguments.frames, arguments.threads};
    if (bench.programs.empty())
        bench.programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    benchmark::run_report(arguments, "OpenCV's RgbdPlane, OctoMap", [&](benchmark::Report& report) {
        report.print("\n");
        report.print(table().heading());
        report.for_each(sequences, [&](const benchmark::SequenceInfo& sequence) {
            for (const results::Json& row : rows_of(sequence, ways, bench)) report.add(row, table());
        });
    });
    return 0;
}

}  // namespace
}  // namespace planemap::bench_run

int main(int argc, char** argv) {
    using namespace planemap::bench_run;
    Arguments arguments;
    arguments.sequences = "redkitchen";
    return planemap::benchmark::run_program("planemap-bench-run", description(), argc, argv, arguments,
                                            add_flags, run);
}
