// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "core/plane_map.hpp"
#include "core/trajectory.hpp"

namespace planemap {

/// report.json of a map that a file holds, which stands alone or beside an octomap.bt of the same session:
/// what only the run knew is null. `trajectory` may be nullptr: not known. What is wrong is among its
/// "warnings".
nlohmann::ordered_json stored_map_report(const std::filesystem::path& map_file, const PlaneMap& map,
                                         const Trajectory* trajectory);

}  // namespace planemap
