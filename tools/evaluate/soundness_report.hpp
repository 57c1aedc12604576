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

}  // namespace planemap::evaluation
