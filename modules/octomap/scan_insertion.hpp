// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <span>

#include "octomap/voxel_set.hpp"

namespace planemap {

/// Inserts scans into an OctoMap with the result of
/// OcTree::insertPointCloud(scan, origin, max_range, lazy_eval = true, discretize = true), several times
/// faster: the cells of a scan are gathered in bitmaps instead of OctoMap's hash sets. Inner nodes are not
/// brought up to date: call updateInnerOccupancy() and prune() when the scans are in.
class ScanInserter {
  public:
    /// Points and origin in the tree's frame, metres; points outside the tree's 16-bit key range are ignored.
    /// max_range < 0: no limit.
    void insert(octomap::OcTree& tree, std::span<const octomap::point3d> points,
                const octomap::point3d& origin, double max_range);

    /// Of the cells of the largest scan so far, kept for the next one.
    std::size_t memory_bytes() const {
        return ends_.memory_bytes() + free_.memory_bytes() + occupied_.memory_bytes();
    }

  private:
    void trace_rays(const octomap::OcTree& tree, const octomap::point3d& origin, double max_range);

    VoxelSet ends_, free_, occupied_;
    octomap::KeyRay ray_;
};

}  // namespace planemap
