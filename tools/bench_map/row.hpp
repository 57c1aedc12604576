// SPDX-License-Identifier: BSD-3-Clause
// One row of the benchmark's table: a sequence with one kind of poses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench_map/run.hpp"
#include "evaluate/judgement_report.hpp"
#include "evaluate/surface_check.hpp"
#include "results/table.hpp"

namespace planemap::bench_map {

using results::Json;

struct Row {
    std::string sequence;
    std::string poses;  ///< "estimated", "true", or "noise1" and so on
    MapRun run;
    std::optional<evaluation::Judgement> judgement;                 ///< nothing without the true planes
    std::vector<evaluation::SurfaceCheck> surfaces;                 ///< empty where it was not done
    std::optional<evaluation::EdgeJudgement> edges = std::nullopt;  ///< nothing without the true planes
    std::optional<evaluation::InferredJudgement> inferred = std::nullopt;  ///< the same
};

/// A row as --json writes it; null for what is not known.
Json to_json(const Row& row);

/// What people see of a row's JSON.
const results::Table& table();

/// What to look at: true planes not found or split, spurious map planes, the worst outline, the pairs with
/// the largest errors, true planes that look alike, surfaces. With `all`, every true plane. Empty if all is
/// well.
std::string details(const Row& row, bool all);

/// What the map should reach and whether each row's JSON does: a line a goal.
std::string goals(const std::vector<Json>& rows);

}  // namespace planemap::bench_map
