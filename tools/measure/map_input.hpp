// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/plane_map.hpp"

namespace planemap {

/// The map that a user names: plane_map.lcmlog or another log with PLANEMAP_MAP, of which the last map
/// counts; a planes.json (by its ending); or a folder of results, whose plane_map.lcmlog, else planes.json it
/// is. Throws std::runtime_error or std::invalid_argument with one line that names file and reason.
PlaneMap read_map(const std::filesystem::path& map);

}  // namespace planemap
