// SPDX-License-Identifier: BSD-3-Clause
// planemap-bench-segmentation: methods that find planes in depth images, on the same frames.
#include <pcl/pcl_config.h>

#include <opencv2/core/version.hpp>

#include "bench_segmentation/benchmark.hpp"
#include "bench_segmentation/table1.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/report.hpp"

namespace planemap::bench {
namespace {

constexpr const char* kProgram = "planemap-bench-segmentation";

struct Arguments : BenchmarkOptions {
    std::string methods = benchmark::names_of(known_methods());
    bool table1 = false;
};

std::string description() {
    return "Methods that find planes in depth images, on the same frames, one thread.\n"
           "Examples:\n  " +
           std::string(kProgram) +
           " --json rows.json                       everything, about 2 minutes\n"
           "  planemap-bench-segmentation --sequences redkitchen --methods cells,ransac/4\n"
           "  planemap-bench-segmentation --table1                                the paper's Table 1\n"
           "  planemap-bench-segmentation --sequences sim:office --methods cells/1 --overlays out/overlays\n"
           "Sequences (and any sim:..., see planemap-simulate --help; seed=1..5 is five of them):\n" +
           benchmark::described(known_sequences(), 20) + "Methods (NAME/N: at subsampling N only):\n" +
           benchmark::described(known_methods(), 20) +
           "Columns:\n"
           "  ms, p95   median and 95th percentile over the frames of the thread's CPU time; the median of\n"
           "            three runs a frame, one run where it takes over 20 ms. Decimation is in it, "
           "spreading\n"
           "            labels back to the full image is not; of ransac it is (the module does all).\n"
           "            Outlines are in cells-outlines only; peers' point clouds and normals are in.\n"
           "  planes    regions a frame, of any size\n"
           "  expl%     readings that carry a label and lie within max(1.5 cm, 3 sigma) of its plane, with\n"
           "            sigma(z) = 0.0012 + 0.0019 (z - 0.4)^2 m\n"
           "  coh%      of the locally planar pixels (17 x 17 pixels around fit a plane within 2 sigma "
           "RMS):\n"
           "            explained by a plane within 20 deg of the local normal\n"
           "  off30%    of the pixels with a label: locally planar, and its plane is more than 30 deg off\n"
           "  rms mm    of the labelled pixels to their planes\n"
           "  rec prec  true and found regions of at least 1000 pixels (at 640 x 480) matched at IoU 0.8\n"
           "  corr over under miss noise   SegComp's instances at 80 % (Hoover et al. 1996)\n"
           "  deg mm    median error of the matched regions' normals, and distances at their centroids\n"
           "  spread    of the five largest world planes' normals and distances from frame to frame under\n"
           "            the true poses: standard deviation weighted by pixels, median of the five\n"
           "Under subsampling, labels spread to the nearest pixels that lie within max(1.5 cm, 3 sigma).";
}

void add_flags(messages::Flags& flags, Arguments& arguments) {
    benchmark::add_flags(flags, arguments,
                         "frames a sequence, evenly spread; 0: each sequence's own, 3 to 100");
    flags.add("methods", arguments.methods, "comma-separated names, see above");
    flags.add("slow-frames", arguments.slow_frames, "at most this many frames for a method that is slow");
    flags.add("table1", arguments.table1, "the paper's Table 1 instead: every method at 1.5, 2.5 and 3.5 m");
    flags.add("overlays", arguments.overlays, "draw what was found: FOLDER/SEQUENCE/FRAME-METHOD.png");
    flags.add("overlay-every", arguments.overlay_every, "a picture of every n-th frame that is run");
}

/// Table 1 has each method at 1, 2 and 4 unless --methods says otherwise.
std::vector<MethodName> table1_methods(const std::string& list) {
    if (list != Arguments().methods) return parse_methods(list);
    std::vector<MethodName> methods;
    for (const MethodInfo& info : known_methods())
        for (const int step : {1, 2, 4}) methods.push_back({info.name, step});
    return methods;
}

int run(const Arguments& arguments) {
    const std::vector<SequenceInfo> sequences =
        benchmark::parse_sequences(arguments.sequences, known_sequences());
    const std::vector<MethodName> methods = parse_methods(arguments.methods);
    const Benchmark runner(arguments);
    if (!arguments.overlays.empty())
        ResultFolder(arguments.overlays, {});  // an error now, not in two minutes
    const std::string peers = "PCL " PCL_VERSION_PRETTY
                              " compiled with these flags (PCL_NO_PRECOMPILE); ransac-debian: Debian's "
                              "build of it; OpenCV " CV_VERSION " as Debian builds it";
    benchmark::run_report(arguments, peers, [&](benchmark::Report& report) {
        if (arguments.table1) return print_table1(table1_methods(arguments.methods), report);
        report.for_each(sequences, [&](const SequenceInfo& sequence) {
            const std::vector<Row> rows = runner.run(sequence, methods);
            report.print("\n" + sequence.name + ": " + sequence.what + "\n" + table().heading());
            for (const Row& row : rows) report.add(to_json(row), table());
        });
    });
    return 0;
}

}  // namespace
}  // namespace planemap::bench

int main(int argc, char** argv) {
    using namespace planemap::bench;
    Arguments arguments;
    arguments.sequences = planemap::benchmark::names_of(known_sequences());
    return planemap::benchmark::run_program(kProgram, description(), argc, argv, arguments, add_flags, run);
}
