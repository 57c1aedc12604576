// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace planemap::bench_run {

/// What a program took from its start to its end, with all the processes that it started.
struct ProgramRun {
    double wall_s = 0;
    double cpu_s = 0;        ///< user and system time of all of them
    double peak_rss_mb = 0;  ///< the sum of what each of them had at most
};

/// Runs a program to its end; its standard output is thrown away. Throws std::runtime_error naming the
/// program and the last line that it said on standard error, if it cannot be started or its exit code is not
/// 0.
ProgramRun run_program_to_end(const std::vector<std::string>& command);

}  // namespace planemap::bench_run
