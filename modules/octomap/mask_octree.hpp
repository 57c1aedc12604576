// SPDX-License-Identifier: BSD-3-Clause
// The plainest octree there is, to hold other maps against: occupied cells, a byte an inner node.
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "octomap/voxel_set.hpp"

namespace planemap::octomap {

/// The cells, of any order, in the smallest cube of 2^depth cells at their low corner: x, y, z of that corner
/// (4 bytes each, the lowest first), the depth (1 byte), and a byte for each inner node, level by level from
/// the root: bit i is set when there is a child with x = i & 1, y = i >> 1 & 1, z = i >> 2. The children of
/// the last level are cells.
std::string mask_octree(const std::vector<Voxel>& cells);

/// The cells that have these centres, by their integer coordinates at an edge of `edge_m`.
std::vector<Voxel> cells_at(const std::vector<Eigen::Vector3d>& centres, double edge_m);

/// A tree in which these cells (centres, metres) are occupied and nothing else is known.
std::unique_ptr<::octomap::OcTree> tree_of(const std::vector<Eigen::Vector3d>& centres, double resolution_m);

}  // namespace planemap::octomap
