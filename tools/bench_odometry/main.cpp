// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-odometry: odometry and graph beside other people's, on the same sequences.
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>

#include "bench_odometry/benchmark.hpp"
#include "bench_odometry/plots.hpp"
#include "bench_odometry/table2.hpp"
#include "benchmark/build_info.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/data_folder.hpp"
#include "core/files.hpp"
#include "messages/process.hpp"
#include "results/output_file.hpp"

namespace planemap::bench_odometry {
namespace {

constexpr const char* kProgram = "planemap-bench-odometry";

struct Arguments {
    std::string sequences, methods;
    BenchmarkOptions benchmark;
    std::filesystem::path json, plots;
    bool table2 = false;
};

/// Where a user's programs may keep what they can make again.
std::filesystem::path default_cache_folder() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (cache != nullptr && *cache != '\0') return std::filesystem::path(cache) / kProgram;
    return (home != nullptr ? std::filesystem::path(home) / ".cache" : std::filesystem::path("/tmp")) /
           kProgram;
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
           "Sequences:\n" +
           described(known_sequences(), 19) + "Methods:\n" + described(known_methods(), 19) +
           "Columns:\n"
           "  frames, lost   frames read; those without a pose, broken ones included\n"
           "  ATE m          absolute trajectory error after rigid alignment, RMSE, and the rest as TUM's\n"
           "                 evaluate_ate.py and evaluate_rpe.py define it\n"
           "  frame mm deg   relative pose error from pose to pose, RMSE\n"
           "  1 s mm deg     relative pose error over one second, RMSE\n"
           "  scale %        what the estimate still has to be scaled by: -1 is 1 % too large\n"
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
           "the next; mean and deviation of the runs' RMSE.\n"
           "Simulated sequences are rendered once and kept in the cache (--cache); they take up to 300 kB a "
           "frame.";
}

void add_flags(Flags& flags, Arguments& arguments) {
    BenchmarkOptions& options = arguments.benchmark;
    flags.add("sequences", arguments.sequences, "comma-separated names, see above");
    flags.add("methods", arguments.methods, "comma-separated names, see above");
    flags.add("frames", options.frames, "frames a sequence, from its start; 0: all");
    flags.add("slow-frames", options.slow_frames,
              "at most this many frames, from the start, for OpenCV's methods; 0: as the others");
    flags.add("data", options.data, "folder of the recordings; default: $PLANEMAP_DATA, or ../shared/data");
    flags.add("cache", options.cache, "folder of rendered sequences; safe to remove");
    flags.add("json", arguments.json,
              "write the rows to this file, or to - (standard output; tables then go to stderr)");
    flags.add("plots", arguments.plots, "draw trajectories over the truth from above: FOLDER/SEQUENCE.svg");
    flags.add(
        "table2", arguments.table2,
        "the paper's Table 2 instead: five places of an office visited again and again, and redkitchen");
    flags.add("q,quiet", options.quiet, "no progress on stderr");
    flags.add(options_of(options.pipeline.segmentation), "segmentation-");
    flags.add(options_of(options.pipeline.odometry), "odometry-");
    flags.add(options_of(options.pipeline.graph), "graph-");
}

/// FOLDER/kt0.svg from sim:kt0.
void write_plot(const std::filesystem::path& folder, const Sequence& sequence, const std::vector<Row>& rows) {
    std::filesystem::create_directories(folder);
    const std::string name = sequence.name.substr(sequence.name.find(':') + 1);
    write_file(folder / (name + ".svg"), plot_svg(sequence.name, *sequence.truth, rows));
}

/// Runs every method on one sequence; prints and keeps each row as it comes.
void run_sequence(const Benchmark& benchmark, const SequenceInfo& info,
                  const std::vector<MethodInfo>& methods, const std::filesystem::path& plots,
                  OutputFile& output, nlohmann::ordered_json& json) {
    std::FILE* out = output.for_people();
    std::string missing;
    const std::optional<Sequence> sequence = benchmark.open(info, missing);
    if (!sequence) {
        std::fprintf(out, "\n%s: skipped. %s\n", info.name.c_str(), missing.c_str());
        return;
    }
    std::fprintf(out, "\n%s: %s\n%s", info.name.c_str(), info.what.c_str(), table_heading().c_str());
    std::vector<Row> rows;
    for (const MethodInfo& method : methods) {
        std::fflush(out);
        rows.push_back(benchmark.run(*sequence, method));
        std::fputs(table_line(rows.back()).c_str(), out);
        json.push_back(to_json(rows.back()));
    }
    std::fflush(out);
    output.keep(json.dump(1) + "\n");  // what was measured is kept if a later one fails
    if (!plots.empty() && sequence->truth) write_plot(plots, *sequence, rows);
}

/// Without --methods, Table 2 leaves out what is slow.
std::vector<MethodInfo> methods_of(const Arguments& arguments) {
    std::vector<MethodInfo> methods = parse_methods(arguments.methods);
    if (arguments.table2 && arguments.methods == names_of(known_methods()))
        std::erase_if(methods, [](const MethodInfo& method) { return method.slow; });
    return methods;
}

int run(const Arguments& arguments) {
    std::vector<SequenceInfo> sequences = parse_sequences(arguments.sequences);
    const std::vector<MethodInfo> methods = methods_of(arguments);
    const Benchmark benchmark(arguments.benchmark);
    OutputFile output(arguments.json);
    if (!arguments.plots.empty()) ResultFolder(arguments.plots, {});  // an error now, not in an hour
    std::FILE* out = output.for_people();
    std::fputs(build_info("OpenCV " CV_VERSION " as Debian builds it").c_str(), out);
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    if (arguments.table2) {
        json = print_table2(benchmark, methods, out);
        sequences.clear();
    }
    for (const SequenceInfo& sequence : sequences)
        run_sequence(benchmark, sequence, methods, arguments.plots, output, json);
    output.finish(json.dump(1) + "\n");
    return 0;
}

}  // namespace
}  // namespace planemap::bench_odometry

int main(int argc, char** argv) {
    using namespace planemap::bench_odometry;
    Arguments arguments;
    arguments.sequences = planemap::names_of(known_sequences());
    arguments.methods = planemap::names_of(known_methods());
    arguments.benchmark.data = planemap::default_data_folder();
    arguments.benchmark.cache = default_cache_folder();
    planemap::Flags flags(kProgram, description());
    add_flags(flags, arguments);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    planemap::start_logging(kProgram, false);
    return planemap::run_main(kProgram, [&] { return run(arguments); });
}
