// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/keyframe.hpp"
#include "octomap/kept_keyframes.hpp"
#include "octomap/keyframe_tracer.hpp"
#include "octomap/octomap_sizes.hpp"
#include "octomap/options.hpp"
#include "octomap/stored_scan.hpp"
#include "octomap/tree_blocks.hpp"
#include "octomap/tree_rebuild.hpp"

namespace planemap::octomap {

/// Builds an OctoMap from the keyframes' depth images, beside the map of planes, and rebuilds it when the
/// graph moves keyframes. OctoMap's update is not exactly independent of order (log-odds are clamped), so
/// scans enter by ascending keyframe id, and what is to be moved is not taken out again: the blocks of the
/// tree that it touched or touches now are built anew, from all keyframes that see them.
///
/// Two ways to use it, with the same tree in the end: add(), update() and flush(); or keep(), update() and
/// advance() from a thread that has other things to do between the steps. The tree stays whole and grows on
/// while a rebuild is under way, and a rebuild always ends: what moves meanwhile is for the next one.
///
/// KeptKeyframes knows the depth images and where they belong, TreeRebuild what is under way; the builder
/// owns the trees, and decides what is next.
class OctomapBuilder {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit OctomapBuilder(OctomapOptions options = {});

    /// Takes what is kept of a depth image, a keyframe's or a look's, as it came from the depth camera (not
    /// registered: the pose of the depth camera is world_from_camera * camera.color_from_depth). Readings
    /// outside the camera's depth range are left out. A known id replaces the earlier one. Unless a rebuild
    /// is due, it is in the tree at once. Returns false, and takes nothing, for an invalid pose, or an id
    /// that is not above all frozen ones.
    ///
    /// It moves with the keyframe of its anchor: a keyframe's own with itself, a look's with the keyframe
    /// that it was tracked against. Of the looks of one number, the last counts; they come into the tree
    /// after their keyframe.
    bool add(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
             const ScanAnchor& anchor);

    /// Takes new poses. Returns true when a rebuild is due, because keyframes moved; flush() carries it out,
    /// so that many corrections cost one rebuild. One that the last trajectory named and this one does not
    /// was replaced: its depth moves with the keyframe nearest to it (KeyframePoses). Frozen ones stay where
    /// they are.
    bool update(const KeyframeTrajectory& trajectory);

    /// Rebuilds if it is due, and brings inner nodes up to date and prunes.
    void flush();

    /// add() without touching the tree: advance() will.
    bool keep(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
              const ScanAnchor& anchor);
    /// Does one piece of what is due, about the work of one scan: freezes what is too much, inserts a new
    /// keyframe, or, if `may_rebuild`, goes on with the rebuild. Returns false when there was nothing to do.
    /// After a stop was requested the tree is not whole: the builder can only be destroyed.
    bool advance(bool may_rebuild, const std::stop_token& stop = {});
    /// Brings inner nodes up to date and prunes; what is not in the tree yet stays out of it.
    void tidy(const std::stop_token& stop = {});
    /// True while some keyframe in the tree is not where it should be.
    bool rebuild_due() const { return rebuild_ || keyframes_.misplaced() > 0 || dirty_.size() > 0; }
    /// Keyframes that are kept and not in the tree yet.
    std::size_t waiting() const { return keyframes_.waiting(); }
    /// Keyframes in the tree, frozen ones included.
    std::size_t keyframes_in_tree() const { return frozen_ + keyframes_.inside(); }

    /// The tree as of the last flush() or tidy().
    const ::octomap::OcTree& tree() const { return *tree_; }
    /// Sizes of the tree as of the last flush() or tidy().
    OctomapSizes sizes() const { return sizes_of(*tree_); }
    /// The bytes of a .bt file: maximum likelihood, pruned.
    std::string bt() const { return bt_of(*tree_); }
    /// Centres of all occupied cells of the smallest leaf's size, world frame, metres.
    std::vector<Eigen::Vector3d> occupied_voxels() const { return occupied_voxels_of(*tree_); }

    /// Voxels of the given edge that hold at least one point of the kept depth images at their newest poses.
    VoxelSet voxel_cloud(double voxel_m) const { return keyframes_.voxel_cloud(voxel_m, options_.subsample); }
    /// The tree that this one would be at another resolution, brought up to date: all kept depth images, each
    /// where it is in the tree's keyframes now. Null when there are frozen ones, whose depth is no longer
    /// known. As long as the scans take.
    std::unique_ptr<::octomap::OcTree> tree_at(double resolution_m) const;

    /// Bytes of the depth images kept for rebuilding.
    std::size_t stored_bytes() const { return keyframes_.bytes(); }
    /// What it takes to go on building: the trees (of a rebuild and of the frozen keyframes too), the depth
    /// images kept and the scratch memory of a scan. A walk over the trees: not for every message.
    std::size_t working_bytes() const;
    /// Keyframes whose depth is no longer kept.
    std::size_t frozen() const { return frozen_; }
    /// How often the tree was rebuilt.
    std::size_t rebuilds() const { return rebuilds_; }

    /// Hears of each scan that enters the tree, in order of time, before and after it does. One that is not
    /// above the last begins the growth anew.
    using GrowthListener = std::function<void(ScanId id, const ::octomap::OcTree& tree, bool is_in)>;
    /// With a listener flush() rebuilds the whole tree, scan by scan, so that it hears how it grows with all
    /// scans where they are now; the tree is the same. What is heard is not the whole growth once keyframes
    /// were frozen and the tree rebuilt. Of trees that advance() rebuilds nothing is heard.
    void listen(GrowthListener listener) { listener_ = std::move(listener); }
    /// Whether the listener heard all of the tree's growth.
    bool is_growth_heard() const { return listener_ && (frozen_ == 0 || rebuilds_ == 0); }

  private:
    bool insert_next(const std::stop_token& stop);
    void insert(ScanId id, const KeptKeyframe& keyframe, const std::stop_token& stop);
    void regrow();
    bool rebuild_next(const std::stop_token& stop);
    void begin_rebuild();
    void end_rebuild();
    bool is_full() const { return keyframes_.size() > options_.max_keyframes; }
    void freeze_oldest(const std::stop_token& stop);
    void mark_dirty(const std::vector<Voxel>& blocks);

    OctomapOptions options_;
    KeptKeyframes keyframes_;
    KeyframeTracer tracer_;
    std::unique_ptr<::octomap::OcTree> base_;  ///< of the frozen keyframes; null while there are none
    std::unique_ptr<::octomap::OcTree> tree_;
    BlockSet dirty_;  ///< blocks to be built anew for keyframes that are not kept any more
    std::optional<TreeRebuild> rebuild_;
    GrowthListener listener_;
    bool stale_ = false;  ///< inner nodes are not up to date
    std::size_t frozen_ = 0, rebuilds_ = 0;
};

}  // namespace planemap::octomap
