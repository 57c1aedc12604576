// SPDX-License-Identifier: BSD-3-Clause
// What programs say of an Evaluation as JSON. Their keys differ, for each is read by scripts of its own.
#pragma once

#include "evaluate/evaluation.hpp"
#include "results/table.hpp"

namespace planemap::evaluation {

/// planemap-evaluate's: poses, pairs, path, scale, and all figures of each error. An RPE that could not be
/// measured is null, and "..._why" says why. Precondition: there is an ATE.
results::Json all_figures(const Evaluation& evaluation);

/// Of one RPE: pairs, those left out, "trans" in metres and "rot_deg"; null for none.
results::Json relative_figures(const std::optional<RelativeError>& error);

/// The "accuracy" of a run's report.json: RMSEs, scale, pairs, path and extent. Precondition: there is an
/// ATE.
results::Json accuracy_figures(const Evaluation& evaluation);

/// A benchmark row's: path, RMSEs and scale; null for what could not be measured, all null without truth.
results::Json row_figures(const std::optional<Evaluation>& evaluation);

}  // namespace planemap::evaluation
