// SPDX-License-Identifier: BSD-3-Clause
// A judgement of a map as figures and as lines for people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/edge_judge.hpp"
#include "evaluate/inferred_judge.hpp"
#include "evaluate/plane_judge.hpp"
#include "evaluate/statistics.hpp"
#include "results/table.hpp"

namespace planemap::evaluation {

using results::Json;

/// Errors over pairs of planes, metres or degrees; those of distances also in percent of the true distance.
Statistics errors_of(const std::vector<PairMeasure>& pairs);
Statistics relative_errors_of(const std::vector<PairMeasure>& pairs);

/// One of the figures; null for no values.
Json figure_of(const Statistics& errors, double Statistics::*figure);

/// The figures of a judgement, metres, degrees, percent and shares as their keys say; null for what is not
/// known, without a judgement for everything.
Json figures_of(const std::optional<Judgement>& judgement);
Json edge_figures(const std::optional<EdgeJudgement>& edges);
Json inferred_figures(const std::optional<InferredJudgement>& inferred);

/// What to look at: true planes not found or split, spurious map planes, the worst outline, the pairs with
/// the largest errors, map planes on several true ones, true planes that look alike. With `all`, every true
/// plane. Empty if all is well.
std::string judgement_details(const Judgement& judgement, bool all);

}  // namespace planemap::evaluation
