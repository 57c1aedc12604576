// SPDX-License-Identifier: BSD-3-Clause
// What a map's size buys: how far depth readings lie from the planes, and from the leaves of voxel maps.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/histogram.hpp"
#include "evaluate/soundness.hpp"
#include "octomap/voxel_set.hpp"

namespace octomap {
class OcTree;
}

namespace planemap {

/// Distances, in constant memory.
class Distances {
  public:
    void add(double metres);
    std::int64_t count() const { return mm_.count(); }
    double rms_m() const;     ///< 0 for none
    double median_m() const;  ///< right within 1 %; 0 for none

  private:
    Histogram mm_;
    double squares_ = 0;
};

/// How far readings are from a voxel map's leaves of one size.
struct LeafRow {
    double resolution_m = 0, rms_m = 0, median_m = 0;
};

/// The size of leaves that has this figure, on the straight line between the two sizes around it; nothing
/// where no two are. Rows by falling resolution.
std::optional<double> equal_resolution(const std::vector<LeafRow>& rows, double LeafRow::*figure,
                                       double value);

/// Compares, over the readings within 5 cm of a plane's outline:
/// - their distance to that plane,
/// - along the same normal, their distance to the centre of the leaf that holds them, for leaves of
///   kResolutions_m: of the readings voxelised, so of a voxel map that keeps every one of them, on OctoMap's
///   lattice,
/// - the same to the nearest occupied leaf of an OctoMap, of the leaf that holds them and its 26 neighbours.
class LeafAccuracy {
  public:
    static constexpr double kResolutions_m[] = {0.10, 0.08, 0.06, 0.05, 0.04, 0.03, 0.02, 0.015, 0.01};

    /// The tree may be null.
    explicit LeafAccuracy(const ::octomap::OcTree* tree);

    void add(const evaluation::JudgedReading& reading);
    std::vector<LeafRow> rows() const;
    /// "readings", "planes", "leaves", "octomap" (null without a tree) and "equal_resolution_m"; null for
    /// what there are no readings for.
    nlohmann::ordered_json figures() const;

  private:
    struct Tree {
        double resolution_m;
        octomap::VoxelSet occupied;
        Distances distances;
        std::int64_t without_leaf = 0;
    };
    void add_to_tree(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal);

    Distances to_planes_;
    std::vector<Distances> to_leaves_;  ///< by resolution
    std::unique_ptr<Tree> tree_;
};

/// What "accuracy_beside_size" of a report says, as a section of it; nothing if it was not measured. Throws
/// nlohmann::json::exception for what is none.
std::string leaf_accuracy_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
