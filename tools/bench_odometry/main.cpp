// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-odometry: odometry and graph beside other people's, on the same sequences.
#include <opencv2/core/version.hpp>

#include "bench_odometry/bad_moments.hpp"
#include "bench_odometry/benchmark.hpp"
#include "bench_odometry/plots.hpp"
#include "bench_odometry/table2.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/rendering.hpp"
#include "benchmark/report.hpp"
#include "core/files.hpp"

namespace planemap::bench_odometry {
namespace {

constexpr const char* kProgram = "planemap-bench-odometry";

struct Arguments : BenchmarkOptions {
    std::string methods = benchmark::names_of(known_methods());
    std::filesystem::path plots;
    bool table2 = false;
    bool bad_moments = false;
    std::string moments;
};

std::string columns_text() {
    return "Columns:\n"
           "  frames, lost   frames read; those without a pose, broken ones included\n"
           "  ATE m          absolute trajectory error after rigid alignment, RMSE, and the rest as TUM's\n"
           "                 evaluate_ate.py and evaluate_rpe.py define it\n"
           "  frame mm deg   relative pose error from pose to pose, RMSE\n"
           "  1 s mm deg     relative pose error over one second, RMSE\n"
           "  scale %        what the estimate still has to be scaled by: -1 is 1 % too large\n"
           "  NEES %         frames whose pose against their keyframe, odometry_t's, has a normalised "
           "estimation error\n"
           "                 squared (6 values, by odometry_t's covariance) below 12.59: 95 if it is honest\n"
           "  ms, p95        of the odometry, a frame: CPU time of its thread, median and 95th percentile;\n"
           "                 decoding, registering depth to colour and segmentation are not in it\n"
           "  seg ms         of the segmentation, a frame: median CPU time\n"
           "  graph s        CPU time of the graph, all keyframes\n"
           "  CPU s, RSS MB  of the row's whole process: reading, decoding and segmentation included\n"
           "  kf, true false keyframes; loop closures that are true and false: a false one's relative pose "
           "is\n"
           "                 more than 10 cm + 2 % of the true distance, or 5 deg, from the true one\n"
           "Table 2 takes the first visit of a place as the truth: a later visit's reference is the first "
           "one's\n"
           "estimate times the true motion in between. ATE over all later visits after alignment, RPE from "
           "one "
           "to\n"
           "the next; mean and deviation of the runs' RMSE.\n";
}

std::string bad_moments_text() {
    return "Bad moments: images are disturbed, and each frame from then on is judged. Sequences:\n" +
           benchmark::described(bad_sequence_infos(), 23) + "Moments:\n" +
           benchmark::described(known_disturbances(), 23) +
           "A pose is held against the last tracked frame before the moment, both in the odom frame; in a "
           "part "
           "that\n"
           "begins later (a keyframe without an edge, or with one whose sigma is over 20 cm or 10 deg), "
           "against "
           "the\n"
           "first tracked frame of that part: nothing is claimed of where two parts lie about each other.\n"
           "  wrong          more than 10 cm or 5 deg off, and neither lost nor both said to be degenerate "
           "or "
           "stale\n"
           "                 and within 3 sigma; sigma is of both frames and of the keyframes' edges in "
           "between\n"
           "  no pose        lost, or a sigma over 20 cm or 10 deg\n"
           "  degen., stale  frames of that status\n"
           "  parts          keyframes without an edge since\n"
           "  worst m, deg   largest errors of poses that are right or wrong, not of those that are "
           "admitted\n"
           "  NEES %         as above\n"
           "Returns: a round, then 21 times a pause of 180 s and 12 frames of the second round. Found: "
           "within "
           "these\n"
           "a frame has a pose against a keyframe from before the pause, or a loop closure ties one to such; "
           "false:\n"
           "one of these relations is false as a loop closure is.\n";
}

std::string description() {
    return "Odometry and graph beside other people's, on the same sequences. Each row runs in a process of "
           "its own,\n"
           "on one thread.\n"
           "Examples:\n"
           "  planemap-bench-odometry --json rows.json              everything\n"
           "  planemap-bench-odometry --sequences redkitchen,sim:kt0 --methods default,default-no-graph\n"
           "  planemap-bench-odometry --sequences fr1_rpy_start --methods default "
           "--odometry-max-points 200\n"
           "  planemap-bench-odometry --sequences redkitchen --plots out/plots\n"
           "  planemap-bench-odometry --table2                      the paper's Table 2\n"
           "  planemap-bench-odometry --bad-moments                 what is said of covered, stuck, dark ... "
           "images\n"
           "Sequences (and any sim:..., see planemap-simulate --help; seed=1..5 is five of them):\n" +
           benchmark::described(known_sequences(), 19) + "Methods:\n" +
           benchmark::described(known_methods(), 19) + columns_text() + bad_moments_text() +
           "Simulated sequences are rendered once and kept in the cache (--cache); they take up to 300 kB a "
           "frame.";
}

void add_flags(messages::Flags& flags, Arguments& arguments) {
    benchmark::add_flags(flags, arguments, "frames a sequence, from its start; 0: all");
    flags.add("methods", arguments.methods, "comma-separated names, see above");
    flags.add("slow-frames", arguments.slow_frames,
              "at most this many frames, from the start, for OpenCV's methods; 0: as the others");
    flags.add("cache", arguments.cache, "folder of rendered sequences; safe to remove");
    flags.add("plots", arguments.plots, "draw trajectories over the truth from above: FOLDER/SEQUENCE.svg");
    flags.add(
        "table2", arguments.table2,
        "the paper's Table 2 instead: five places of an office visited again and again, and redkitchen");
    flags.add("bad-moments", arguments.bad_moments,
              "bad moments instead: of --sequences those in its own list, by the default method");
    flags.add("moments", arguments.moments,
              "comma-separated names of bad moments; empty: all, and the returns");
    flags.add(options_of(arguments.pipeline.segmentation), "segmentation-");
    flags.add(options_of(arguments.pipeline.odometry), "odometry-");
    flags.add(options_of(arguments.pipeline.graph), "graph-");
}

/// FOLDER/kt0.svg from sim:kt0.
void write_plot(const std::filesystem::path& folder, const Sequence& sequence, const std::vector<Row>& rows) {
    std::filesystem::create_directories(folder);
    const std::string name = sequence.name.substr(sequence.name.find(':') + 1);
    write_file(folder / (benchmark::file_name_of(name) + ".svg"),
               plot_svg(sequence.name, *sequence.truth, rows));
}

/// Runs every method on one sequence; reports each row as it comes.
void run_sequence(const Benchmark& runner, const SequenceInfo& info, const std::vector<MethodInfo>& methods,
                  const std::filesystem::path& plots, benchmark::Report& report) {
    const Sequence sequence = runner.open(info);
    report.print("\n" + info.name + ": " + info.what + "\n" + table().heading());
    std::vector<Row> rows;
    for (const MethodInfo& method : methods) {
        rows.push_back(runner.run(sequence, method));
        report.add(to_json(rows.back()), table());
    }
    if (!plots.empty() && sequence.truth) write_plot(plots, sequence, rows);
}

/// Without --methods, Table 2 leaves out what is slow.
std::vector<MethodInfo> methods_of(const Arguments& arguments) {
    std::vector<MethodInfo> methods = parse_methods(arguments.methods);
    if (arguments.table2 && arguments.methods == Arguments().methods)
        std::erase_if(methods, [](const MethodInfo& method) { return method.slow; });
    return methods;
}

/// Without --sequences, bad moments are of their own.
std::string bad_sequences_of(const Arguments& arguments) {
    if (arguments.sequences != benchmark::names_of(known_sequences())) return arguments.sequences;
    return benchmark::names_of(bad_sequence_infos());
}

int run_bad_moments(const Arguments& arguments) {
    arguments.validate();
    benchmark::run_report(arguments, "no peers", [&](benchmark::Report& report) {
        print_bad_moments(arguments, bad_sequences_of(arguments), arguments.moments, report);
    });
    return 0;
}

int run(const Arguments& arguments) {
    if (arguments.bad_moments) return run_bad_moments(arguments);
    const std::vector<SequenceInfo> sequences =
        benchmark::parse_sequences(arguments.sequences, known_sequences());
    const std::vector<MethodInfo> methods = methods_of(arguments);
    const Benchmark runner(arguments);
    if (!arguments.plots.empty()) ResultFolder(arguments.plots, {});  // an error now, not in an hour
    const std::string peers = "OpenCV " CV_VERSION " as Debian builds it";
    benchmark::run_report(arguments, peers, [&](benchmark::Report& report) {
        if (arguments.table2) return print_table2(runner, methods, report);
        report.for_each(sequences, [&](const SequenceInfo& info) {
            run_sequence(runner, info, methods, arguments.plots, report);
        });
    });
    return 0;
}

}  // namespace
}  // namespace planemap::bench_odometry

int main(int argc, char** argv) {
    using namespace planemap::bench_odometry;
    Arguments arguments;
    arguments.sequences = planemap::benchmark::names_of(known_sequences());
    arguments.cache = planemap::benchmark::default_cache_folder(kProgram);
    return planemap::benchmark::run_program(kProgram, description(), argc, argv, arguments, add_flags, run);
}
