// SPDX-License-Identifier: BSD-3-Clause
// The size report: what the plane map takes beside other maps of the same run, and at what coverage.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace planemap {

/// report.md from report.json: tracking, accuracy, warnings, sizes (sizes_markdown()), times. What was not
/// measured is said not to be. Throws std::runtime_error naming
/// the key if the JSON is no planemap report.
std::string report_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
