// SPDX-License-Identifier: BSD-3-Clause
// OpenVDB beside the other maps; only built with -DPLANEMAP_OPENVDB=ON.
#pragma once

#include <string>
#include <vector>

#include "octomap/voxel_set.hpp"

namespace planemap {

/// What OpenVDB writes of the topology of a tree in which these cells are active: no values, no metadata.
std::string vdb_topology(const std::vector<octomap::Voxel>& cells);

}  // namespace planemap
