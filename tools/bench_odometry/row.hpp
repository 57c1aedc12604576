// SPDX-License-Identifier: BSD-3-Clause
// One row of the benchmark's table: a method on a sequence.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench_odometry/run.hpp"
#include "evaluate/evaluation.hpp"

namespace planemap::bench_odometry {

struct Row {
    std::string sequence, method;
    MethodRun run;
    double cpu_s = 0, peak_rss_mb = 0;               ///< of the whole process, reading and decoding included
    std::optional<Evaluation> evaluation;            ///< nothing without truth
    std::vector<std::optional<ClosureError>> loops;  ///< of run.closures, see judge()

    /// Frames without a pose: broken ones, and those before the first keyframe, included.
    std::int64_t lost() const { return run.frames - static_cast<std::int64_t>(run.trajectory.size()); }
};

/// Compares a run with the truth, if there is one.
Row make_row(const std::string& sequence, const std::string& method, const std::optional<Trajectory>& truth,
             MethodRun run);

/// The heading and the lines of a table with aligned columns; "-" for what the data does not allow.
std::string table_heading();
std::string table_line(const Row& row);

/// A row as --json writes it; null for what the data does not allow.
nlohmann::ordered_json to_json(const Row& row);

}  // namespace planemap::bench_odometry
