// SPDX-License-Identifier: BSD-3-Clause
// The ways to map a recording whose whole cost is measured, and the peers beside them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/sequences.hpp"
#include "results/table.hpp"

namespace planemap::bench_run {

struct WayInfo {
    std::string name;
    std::string what;  ///< one line for --help
};
const std::vector<WayInfo>& known_ways();
/// One line each.
std::string described_ways();

/// What is measured, and with which programs.
struct Bench {
    std::filesystem::path programs;  ///< the folder of planemap-run and the others
    std::filesystem::path data;
    std::filesystem::path scratch;  ///< a folder for logs and results; exists
    int frames = 0;                 ///< of the runs; 0: all
    int threads = 0;                ///< of planemap-run; 0: as many as it takes by itself
};

/// Rows of a sequence, one a way, in the order given; then those of the peers. A row's "sequence", "way",
/// "frames", "frames_per_s", "cpu_s", "cpu_ms" (a frame), "r" (the same over R), "r_ms" (R: the median of
/// RgbdPlane's CPU time on every 4th pixel of the sequence's depth), "report_cpu_s" (of "cpu_s", the making
/// of the report) and "peak_rss_mb"; null for what is not known. Throws std::runtime_error naming the program
/// that failed and why, and benchmark::DataMissing.
std::vector<results::Json> rows_of(const benchmark::SequenceInfo& sequence, const std::vector<WayInfo>& ways,
                                   const Bench& bench);

results::Table table();

}  // namespace planemap::bench_run
