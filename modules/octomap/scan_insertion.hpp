// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <span>
#include <stop_token>
#include <vector>

#include "octomap/block_table.hpp"
#include "octomap/tree_blocks.hpp"

namespace planemap::octomap {

/// Inserts scans into an OctoMap with the result of
/// OcTree::insertPointCloud(scan, origin, max_range, lazy_eval = true, discretize = true), many times faster:
/// the cells of a scan are gathered in a grid of bitmaps instead of OctoMap's hash sets, and the tree is
/// entered once for a block of them (TreeUpdate). Inner nodes are not brought up to date: call
/// bring_up_to_date() when the scans are in.
class ScanInserter {
  public:
    /// Points and origin in the tree's frame, metres; points outside the tree's 16-bit key range are ignored.
    /// max_range < 0: no limit.
    void insert(::octomap::OcTree& tree, std::span<const ::octomap::point3d> points,
                const ::octomap::point3d& origin, double max_range) {
        trace(tree, points, origin, max_range);
        apply(tree);
    }

    /// The first half of insert(): finds the cells that the scan passes and hits. Of the tree only its
    /// geometry is used. Once a stop is requested, what is found is not complete.
    void trace(const ::octomap::OcTree& tree, std::span<const ::octomap::point3d> points,
               const ::octomap::point3d& origin, double max_range, const std::stop_token& stop = {});
    /// The second half: updates the cells that trace() found; if blocks are given, only those in them.
    /// Once a stop is requested, not all of them.
    void apply(::octomap::OcTree& tree, const BlockSet* only = nullptr,
               const std::stop_token& stop = {}) const;
    /// The blocks that the cells of the last trace() lie in.
    std::vector<Voxel> blocks() const;

    /// Of the cells of the largest scan so far, kept for the next one.
    std::size_t memory_bytes() const { return cells_.memory_bytes(); }

  private:
    /// Of 8x8x8 cells, by their OctoMap keys.
    struct Block {
        BlockBits passed{};  ///< by rays
        BlockBits hit{};     ///< which counts, where a cell is both
    };
    class Ray;

    void cast(const ::octomap::OcTree& tree, const ::octomap::point3d& origin, const ::octomap::point3d& end);

    BlockTable<Block> cells_;
};

}  // namespace planemap::octomap
