// SPDX-License-Identifier: BSD-3-Clause
// The size report: what the plane map takes beside other maps of the same run, and at what coverage.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace planemap {

/// report.json of an output folder. Throws std::runtime_error or std::invalid_argument with one line that
/// names the file: why there is none, and what to do; or what is wrong in it, and where.
nlohmann::ordered_json read_report(const std::filesystem::path& folder);

/// report.md from report.json: tracking, accuracy, warnings, sizes (sizes_markdown()), times. What was not
/// measured is said not to be. Throws std::runtime_error naming the field, without the file, if the JSON is
/// no planemap report.
std::string report_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
