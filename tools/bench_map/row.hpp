// SPDX-License-Identifier: BSD-3-Clause
// One row of the benchmark's table: a sequence with one kind of poses.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench_map/judge.hpp"
#include "bench_map/run.hpp"
#include "bench_map/surface_check.hpp"

namespace planemap::bench_map {

struct Row {
    std::string sequence;
    std::string poses;  ///< "estimated" or "true"
    MapRun run;
    std::optional<Judgement> judgement;  ///< nothing without the true planes
    std::vector<SurfaceCheck> surfaces;  ///< empty where it was not done
};

/// Figures over pairs of planes; the errors of distances also as shares of the true distance.
struct ErrorFigures {
    double mean = 0, median = 0, worst = 0;
};
/// Nothing for no pairs.
std::optional<ErrorFigures> errors_of(const std::vector<PairMeasure>& pairs);
std::optional<ErrorFigures> relative_errors_of(const std::vector<PairMeasure>& pairs);  ///< percent

/// The heading and the lines of a table with aligned columns; "-" for what the data does not allow.
std::string table_heading();
std::string table_line(const Row& row);

/// What to look at: true planes not found or split, spurious map planes, the worst outline, the pairs with
/// the largest errors, true planes that look alike, surfaces. With `all`, every true plane. Empty if all is
/// well.
std::string details(const Row& row, bool all);

/// What the map should reach and whether each row does: a line a goal.
std::string goals(const std::vector<Row>& rows);

/// A row as --json writes it; null for what is not known.
nlohmann::ordered_json to_json(const Row& row);

}  // namespace planemap::bench_map
