// SPDX-License-Identifier: BSD-3-Clause
// A map's soundness as figures and as lines for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluate/soundness.hpp"

namespace planemap::evaluation {

/// "doubled_area", "floating_area", "explained_points", "explained_points_5cm" (shares; null for none),
/// "point_to_plane_rms_m", "point_to_plane_bias_m", and "soundness": what these are of, by plane, pair and
/// range.
nlohmann::ordered_json soundness_figures(const Soundness& soundness);

/// What soundness_figures() says, for the report. Throws nlohmann::json::exception for a report without them.
std::string soundness_markdown(const nlohmann::ordered_json& report);

/// "within_2cm", "within_band", "within_5cm": shares of the readings; "by_range": the same by depth, in steps
/// of 1 m; "outline_seen_within_band": share of the outlines' area. Null for what there is nothing of.
nlohmann::ordered_json coverage_figures(const Soundness& soundness);

/// What coverage_figures() says, and the leaves explained at half a leaf, for the report; nothing if it was
/// not measured. Throws nlohmann::json::exception for what is none.
std::string coverage_markdown(const nlohmann::ordered_json& coverage);

}  // namespace planemap::evaluation
