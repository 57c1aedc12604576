// SPDX-License-Identifier: BSD-3-Clause
// The sizes of the plane map beside those of other maps of the same run: measured, and as text that says what
// is compared with what.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace planemap {

struct PlaneMap;

namespace pipeline {
class Pipeline;
}

/// Adds "sizes", "sizes_bytes", "octomap" and "coverage"; what the map alone does not tell is null.
void add_map_sizes(const PlaneMap& map, nlohmann::ordered_json& report);

/// Adds what an OctoMap's .bt file of the same depth and poses tells, to a report with the map's sizes: its
/// sizes but those of the tree that it was written from, and the coverage. Throws std::runtime_error naming
/// the file if it cannot be read; the report is then as it was.
void add_stored_octomap(const std::filesystem::path& bt_file, const PlaneMap& map,
                        nlohmann::ordered_json& report);

/// The same of a run; what there is no OctoMap for is null. "sizes" tells the OctoMap's at these other
/// resolutions, too, as far as all keyframes' depth is kept.
void add_sizes(pipeline::Pipeline& pipeline, std::int64_t frames, const std::vector<double>& resolutions_m,
               nlohmann::ordered_json& report);

/// The report's section on sizes. A saving is never printed without its coverage, nor an OctoMap's size
/// without its resolution; what was not measured is said not to be. Throws nlohmann::json::exception for a
/// report without sizes.
std::string sizes_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
