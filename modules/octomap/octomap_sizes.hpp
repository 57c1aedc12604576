// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace planemap::octomap {

/// How large an OctoMap is: as it is worked on, as a file, and as that file when it is loaded again.
struct OctomapSizes {
    std::size_t memory_bytes = 0;  ///< OctoMap's own OcTree::memoryUsage() of the tree that is built
    std::size_t allocated_bytes =
        0;  ///< what the same tree takes on the heap, but for OctoMap's 600 kB to cast rays
    std::size_t bt_bytes = 0;                   ///< of the binary, maximum likelihood file
    std::size_t bt_nodes = 0;                   ///< of the tree in that file, the root too
    std::size_t bt_leaves = 0;                  ///< of these, without children
    std::size_t bt_loaded_memory_bytes = 0;     ///< OcTree::memoryUsage() of that file when it is read again
    std::size_t bt_loaded_allocated_bytes = 0;  ///< what that takes on the heap
    std::size_t bt_occupied_bytes = 0;  ///< of a binary file with the occupied space only, free space left
                                        ///< out as if it were not known
    std::size_t ot_bytes = 0;           ///< of the full file
    std::size_t nodes = 0;              ///< all
    std::size_t leaves = 0;             ///< pruned ones count once
    std::size_t occupied_leaves = 0;    ///< pruned ones count once
    std::size_t occupied_voxels = 0;    ///< occupied volume over the volume of the smallest leaf
};

/// Counts one pass over the tree; nothing is copied or written. Precondition: the tree is pruned and its
/// inner nodes are up to date; what is said of the .bt files is right without.
OctomapSizes sizes_of(const ::octomap::OcTree& tree);

/// The bytes of a .bt file: maximum likelihood, pruned.
std::string bt_of(const ::octomap::OcTree& tree);
/// The same with the occupied space only: free space is left out as if it were not known.
std::string bt_occupied_of(const ::octomap::OcTree& tree);
/// The bytes of an .ot file.
std::string ot_of(const ::octomap::OcTree& tree);

/// Centres of all occupied cells of the smallest leaf's size, in the tree's frame, metres.
std::vector<Eigen::Vector3d> occupied_voxels_of(const ::octomap::OcTree& tree);

/// The tree of a .bt file. Throws std::runtime_error naming the file if it cannot be read as one.
std::unique_ptr<::octomap::OcTree> read_bt(const std::filesystem::path& file);

}  // namespace planemap::octomap
