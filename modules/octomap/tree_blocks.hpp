// SPDX-License-Identifier: BSD-3-Clause
// An OctoMap in blocks of 32 x 32 x 32 of its smallest cells: nodes of the tree, and small enough that what a
// keyframe sees is many of them, so that a correction of the poses changes some and not all.
#pragma once

#include <octomap/OcTree.h>

#include <memory>
#include <stop_token>

#include "octomap/voxel_set.hpp"

namespace planemap::octomap {

constexpr int kBlockBits = 5;  ///< 2^5 cells along each edge

/// Blocks by their coordinates: those of their cells divided by 32.
using BlockSet = VoxelSet;

/// The block that a cell (by its OctoMap key) lies in.
inline Voxel block_of(const Voxel& cell) {
    return {cell.x >> kBlockBits, cell.y >> kBlockBits, cell.z >> kBlockBits};
}

/// A tree with the content of `inside` (nothing, if it is null) in the blocks, and of `outside` elsewhere.
/// Both have the same resolution. Inner nodes are not brought up to date. Once a stop is requested, the copy
/// is not complete.
std::unique_ptr<::octomap::OcTree> composed(const ::octomap::OcTree& outside, const ::octomap::OcTree* inside,
                                            const BlockSet& blocks, const std::stop_token& stop = {});

/// Brings inner nodes up to date and prunes: updateInnerOccupancy() and prune() in one walk, which a stop
/// ends early.
void bring_up_to_date(::octomap::OcTree& tree, const std::stop_token& stop = {});

}  // namespace planemap::octomap
