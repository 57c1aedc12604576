// SPDX-License-Identifier: BSD-3-Clause
// Prints the paper's Table 2.
#pragma once

#include <vector>

#include "bench_odometry/benchmark.hpp"
#include "benchmark/report.hpp"
#include "evaluate/revisits.hpp"

namespace planemap::bench_odometry {

/// Mean and deviation over runs of each run's RMSE.
struct Table2Line {
    int runs = 0, revisits = 0, lost = 0;
    Statistics ate_m, rpe_m, rpe_deg;
};
Table2Line summarised(const std::vector<evaluation::RevisitErrors>& runs);

/// Runs the methods through redkitchen, whose five places are found by its true poses, and through four
/// simulated walks about five places of an office in random order, and reports a table each.
void print_table2(const Benchmark& runner, const std::vector<MethodInfo>& methods, benchmark::Report& report);

}  // namespace planemap::bench_odometry
