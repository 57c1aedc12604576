// SPDX-License-Identifier: BSD-3-Clause
// What maps of the same run take, each row saying what it holds: "sizes" and "headline" of report.json.
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/plane_map.hpp"
#include "octomap/octomap_sizes.hpp"
#include "octomap/voxel_set.hpp"

namespace planemap {

/// The resolutions, metres, in a text with commas between; empty: none. Throws std::invalid_argument naming
/// the flag for what is no number from 0.001 to 10.
std::vector<double> size_resolutions(const std::string& text);

/// What bytes take once zstd compressed them, at its own default level.
std::size_t zstd_bytes(std::string_view bytes);

/// A point of a cloud: three floats, as the paper counts.
inline constexpr std::size_t kCloudPointBytes = 12;

/// One map in one form.
struct SizeRow {
    std::string map;   ///< "planes", "octomap", "octree", "openvdb" or "cloud"
    std::string form;  ///< a short name
    std::optional<double> resolution_m = std::nullopt;
    std::size_t bytes = 0;
    std::optional<std::size_t> zstd_bytes = std::nullopt;
    bool in_memory = false;       ///< else a file
    bool free_space = false;      ///< it says where nothing is, too
    const char* goes_on = "no";   ///< what mapping it can go on with: "no", "fixed poses" or "corrections"
    bool explained_only = false;  ///< of the leaves that a plane passes alone
    std::optional<std::size_t> leaves = std::nullopt;

    nlohmann::ordered_json json() const;
};

/// Bytes that go on mapping needs in memory.
struct WorkingBytes {
    std::size_t fixed_poses = 0;  ///< while poses stay as they are
    std::size_t corrections = 0;  ///< when the graph moves keyframes, too
};

/// Rows of the plane map; without `working` those in memory are left out.
void add_plane_rows(const PlaneMap& map, const std::optional<WorkingBytes>& working,
                    nlohmann::ordered_json& rows);

/// How a tree came to be: one that was read from its .bt file does not tell what the working one took.
enum class TreeOrigin { kBuilt, kReadFromBt };

/// Forms of an OctoMap's files.
inline constexpr const char *kBt = ".bt", *kBtOccupied = ".bt, occupied only";

/// Rows of an OctoMap (pruned, inner nodes up to date; `sizes` are its), of the occupied space alone in the
/// forms that there are, and of the leaves that planes explain. `corrections` are the bytes to follow
/// corrections; none: not known.
void add_tree_rows(const ::octomap::OcTree& tree, const octomap::OctomapSizes& sizes, TreeOrigin origin,
                   const PlaneMap& map, std::optional<std::size_t> corrections, nlohmann::ordered_json& rows);

/// Rows of clouds of 1, 2 and 5 cm voxels, 12 bytes each, from that of 1 cm.
void add_cloud_rows(const octomap::VoxelSet& cloud_1cm, nlohmann::ordered_json& rows);

/// "headline" of a report that has "sizes": the planes' message beside the smallest form of the occupied
/// space alone, both compressed, at the finest resolution that is not finer than that of equal accuracy by
/// RMS (accuracy_beside_size), or else at the OctoMap's. Null without an OctoMap.
nlohmann::ordered_json headline_of(const nlohmann::ordered_json& report);

/// The headline and a table of the rows. Empty for a report without them.
std::string size_rows_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
