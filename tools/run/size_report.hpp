// SPDX-License-Identifier: BSD-3-Clause
// The sizes of the plane map beside those of other maps of the same run: measured, and as text that says what
// is compared with what.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace planemap {

struct PlaneMap;

namespace pipeline {
class Pipeline;
}

/// Adds "sizes_bytes", "octomap" and "coverage"; what the map alone does not tell is null.
void add_map_sizes(const PlaneMap& map, nlohmann::ordered_json& report);

/// The same of a run; what there is no OctoMap for is null.
void add_sizes(pipeline::Pipeline& pipeline, std::int64_t frames, nlohmann::ordered_json& report);

/// The report's section on sizes. A saving is never printed without its coverage, nor an OctoMap's size
/// without its resolution; what was not measured is said not to be. Throws nlohmann::json::exception for a
/// report without sizes.
std::string sizes_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
