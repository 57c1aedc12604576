// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <array>

#include "octomap/block_table.hpp"

namespace planemap::octomap {

/// Enters what a scan saw into an OctoMap, a block of cells at a time: the tree is as after
/// OcTree::updateNode(key, occupied, lazy_eval = true) of each cell, but the way from the root, which that
/// goes twice for every cell, is gone once for a block, and not even then where the one before lies near.
class TreeUpdate {
  public:
    /// Nobody else may change the tree while this lives.
    explicit TreeUpdate(::octomap::OcTree& tree) : tree_(tree) {}

    /// Cells that rays passed, and that they hit, by the block's lowest cell (an OctoMap key). No cell is
    /// both.
    void update(const Voxel& low, const BlockBits& misses, const BlockBits& hits);

  private:
    using Node = ::octomap::OcTreeNode;
    static constexpr unsigned kTreeDepth = 16, kBlockDepth = 13;  ///< of OctoMap's cells, and of 8x8x8
    struct Child {
        Node* node;
        bool is_new;
    };

    bool descend(const Voxel& low, bool any_misses, bool any_hits);
    bool open(const Child& inner, bool any_misses, bool any_hits);
    Child child(Node* node, unsigned i);
    void update_octant(const Child& octant, std::uint64_t misses, std::uint64_t hits);
    void update_cells(const Child& parent, unsigned misses, unsigned hits);

    ::octomap::OcTree& tree_;
    std::array<Child, kBlockDepth + 1> path_{};  ///< from the root to the last block
    unsigned reached_ = 0;                       ///< how deep of it
    Voxel last_;                                 ///< the block that it goes to
};

}  // namespace planemap::octomap
