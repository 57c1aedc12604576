// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <stop_token>
#include <vector>

#include "octomap/options.hpp"
#include "octomap/scan_insertion.hpp"
#include "octomap/stored_scan.hpp"
#include "octomap/tree_blocks.hpp"

namespace planemap::octomap {

/// Finds the cells that keyframes' depth images pass and hit, with the range and the pixels that the options
/// ask for, and updates them in any tree of the same resolution. Holds the cells of one image at a time.
class KeyframeTracer {
  public:
    /// Precondition: the options are valid.
    explicit KeyframeTracer(const OctomapOptions& options)
        : max_range_m_(options.max_range_m), subsample_(options.subsample) {}

    /// Finds the cells; of the tree only its geometry is used. Once a stop is requested, not all of them.
    void trace(const ::octomap::OcTree& tree, const StoredScan& scan, const Pose& world_from_camera,
               const std::stop_token& stop = {});
    /// Updates the cells that the last trace() found, if blocks are given only those in them.
    void apply(::octomap::OcTree& tree, const BlockSet* only = nullptr,
               const std::stop_token& stop = {}) const {
        inserter_.apply(tree, only, stop);
    }
    /// The blocks that those cells lie in.
    std::vector<Voxel> blocks() const { return inserter_.blocks(); }

    std::size_t memory_bytes() const { return inserter_.memory_bytes(); }

  private:
    double max_range_m_;  ///< 0: the camera's
    int subsample_;
    ScanInserter inserter_;
};

}  // namespace planemap::octomap
