// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "octomap/octomap_sizes.hpp"
#include "octomap/scan_insertion.hpp"

namespace planemap {

struct OctomapOptions {
    double resolution_m = 0.05;  ///< edge of a leaf
    double max_range_m = 0;      ///< readings further away clear space up to here and occupy nothing; 0: the
                                 ///< camera's depth_max_m
    int subsample = 1;           ///< every n-th pixel along u and v
    std::size_t max_keyframes = 2000;  ///< keyframes whose depth is kept for rebuilding (about 150 KB each).
                                       ///< Beyond it the oldest is frozen at its pose and its depth dropped
    double moved_m = 0.002;            ///< keyframes that moved less than this,
    double moved_deg = 0.05;           ///< and turned less than this, do not cause a rebuild

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Builds an OctoMap from the keyframes' depth images, beside the map of planes, and rebuilds it when the
/// graph moves keyframes. OctoMap's update is not exactly independent of order (log-odds are clamped), so
/// scans enter by ascending keyframe id.
class OctomapBuilder {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit OctomapBuilder(OctomapOptions options = {});

    /// Takes a keyframe's depth image as it came from the depth camera (not registered: the pose of the depth
    /// camera is world_from_camera * camera.color_from_depth). Readings outside the camera's depth range are
    /// left out. A known id replaces the earlier one. Returns false, and takes nothing, for an invalid pose
    /// or an image whose size is not camera.depth's. Throws std::invalid_argument for an invalid camera.
    bool add(int keyframe_id, const DepthImage& depth, const CameraInfo& camera,
             const Pose& world_from_camera);

    /// Takes new poses. Returns true when a rebuild is due, because keyframes moved; flush() carries it out,
    /// so that many corrections cost one rebuild.
    bool update(const KeyframeTrajectory& trajectory);

    /// Rebuilds if it is due, and brings inner nodes up to date and prunes.
    void flush();

    /// The tree as of the last flush().
    const octomap::OcTree& tree() const { return *tree_; }
    /// Sizes of the tree as of the last flush().
    OctomapSizes sizes() const { return sizes_of(*tree_); }
    /// The bytes of a .bt file: maximum likelihood, pruned.
    std::string bt() const { return bt_of(*tree_); }
    /// The bytes of an .ot file.
    std::string ot() const { return ot_of(*tree_); }
    /// Centres of all occupied cells of the smallest leaf's size, world frame, metres.
    std::vector<Eigen::Vector3d> occupied_voxels() const;

    /// Points of a voxel cloud: number of voxels of the given edge that hold at least one point of the kept
    /// depth images at their newest poses.
    std::size_t voxel_cloud_size(double voxel_m) const;

    /// Bytes of the depth images kept for rebuilding.
    std::size_t stored_bytes() const;
    /// What it takes to go on building: the tree, the tree of the frozen keyframes, the depth images kept and
    /// the scratch memory of a scan. A walk over the trees: not for every message.
    std::size_t working_bytes() const;
    /// Keyframes whose depth is no longer kept.
    std::size_t frozen() const { return frozen_; }
    /// How often the tree was rebuilt.
    std::size_t rebuilds() const { return rebuilds_; }

  private:
    /// A keyframe's depth, compressed without loss.
    struct Stored {
        CameraInfo camera;
        std::string deflated;
        Pose world_from_camera;
    };

    std::vector<octomap::point3d> points_in_world(const Stored& stored) const;
    void insert(octomap::OcTree& tree, const Stored& stored);
    void freeze_oldest();

    OctomapOptions options_;
    std::map<int, Stored> keyframes_;        ///< by id
    std::unique_ptr<octomap::OcTree> base_;  ///< of the frozen keyframes; null while there are none
    std::unique_ptr<octomap::OcTree> tree_;
    ScanInserter inserter_;
    bool rebuild_due_ = false;  ///< some keyframe in the tree is not where it should be
    bool stale_ = false;        ///< inner nodes are not up to date
    std::size_t frozen_ = 0, rebuilds_ = 0;
};

}  // namespace planemap
