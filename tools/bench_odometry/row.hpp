// SPDX-License-Identifier: BSD-3-Clause
// One row of the benchmark's table: a method on a sequence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench_odometry/pose_judge.hpp"
#include "bench_odometry/run.hpp"
#include "evaluate/evaluation.hpp"
#include "results/table.hpp"

namespace planemap::bench_odometry {

using results::Json;

struct Row {
    std::string sequence, method;
    MethodRun run;
    double cpu_s = 0, peak_rss_mb = 0;     ///< of the whole process, reading and decoding included
    std::optional<Evaluation> evaluation;  ///< nothing without truth
    std::vector<std::optional<evaluation::ClosureError>> loops;  ///< of run.closures, see judge_closure()
    /// Share of run.relatives whose normalised estimation error squared is below kNees95; nothing without
    /// truth or covariance.
    std::optional<double> nees_share;

    /// Frames without a pose: broken ones, and those before the first keyframe, included.
    std::int64_t lost() const { return run.frames - static_cast<std::int64_t>(run.trajectory.size()); }
};

/// Compares a run with the truth, if there is one.
Row make_row(const std::string& sequence, const std::string& method, const std::optional<Trajectory>& truth,
             MethodRun run);

/// What people see of a row's JSON.
const results::Table& table();

/// A row as --json writes it; null for what the data does not allow.
Json to_json(const Row& row);

}  // namespace planemap::bench_odometry
