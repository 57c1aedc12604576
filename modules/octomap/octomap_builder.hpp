// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "core/option_list.hpp"
#include "core/replacement.hpp"
#include "octomap/octomap_sizes.hpp"
#include "octomap/scan_insertion.hpp"
#include "octomap/stored_scan.hpp"
#include "octomap/tree_blocks.hpp"

namespace planemap::octomap {

/// Options of OctomapBuilder; options_of() says what each is.
struct OctomapOptions {
    double resolution_m = 0.05;
    double max_range_m = 0;
    int subsample = 1;
    std::size_t max_keyframes = 2000;
    double moved_m = 0.002;
    double moved_deg = 0.05;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(OctomapOptions& options);

/// Builds an OctoMap from the keyframes' depth images, beside the map of planes, and rebuilds it when the
/// graph moves keyframes. OctoMap's update is not exactly independent of order (log-odds are clamped), so
/// scans enter by ascending keyframe id, and what is to be moved is not taken out again: the blocks of the
/// tree that it touched or touches now are built anew, from all keyframes that see them.
///
/// Two ways to use it, with the same tree in the end: add(), update() and flush(); or keep(), update() and
/// advance() from a thread that has other things to do between the steps. The tree stays whole and grows on
/// while a rebuild is under way, and a rebuild always ends: what moves meanwhile is for the next one.
class OctomapBuilder {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit OctomapBuilder(OctomapOptions options = {});

    /// Takes a keyframe's depth image as it came from the depth camera (not registered: the pose of the depth
    /// camera is world_from_camera * camera.color_from_depth). Readings outside the camera's depth range are
    /// left out. A known id replaces the earlier one. Unless a rebuild is due, it is in the tree at once.
    /// Returns false, and takes nothing, for an invalid pose, an image whose size is not camera.depth's, or
    /// an id that is not above all frozen ones. Throws std::invalid_argument for an invalid camera.
    bool add(int keyframe_id, const DepthImage& depth, const CameraInfo& camera,
             const Pose& world_from_camera);

    /// Takes new poses. Returns true when a rebuild is due, because keyframes moved; flush() carries it out,
    /// so that many corrections cost one rebuild. One that the last trajectory named and this one does not
    /// was replaced: its depth moves with the keyframe nearest to it (KeyframePoses). Frozen ones stay where
    /// they are.
    bool update(const KeyframeTrajectory& trajectory);

    /// Rebuilds if it is due, and brings inner nodes up to date and prunes.
    void flush();

    /// add() without touching the tree: advance() will.
    bool keep(int keyframe_id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera);
    /// Does one piece of what is due, about the work of one scan: freezes what is too much, inserts a new
    /// keyframe, or, if `may_rebuild`, goes on with the rebuild. Returns false when there was nothing to do.
    /// After a stop was requested the tree is not whole: the builder can only be destroyed.
    bool advance(bool may_rebuild, const std::stop_token& stop = {});
    /// Brings inner nodes up to date and prunes; what is not in the tree yet stays out of it.
    void tidy(const std::stop_token& stop = {});
    /// True while some keyframe in the tree is not where it should be.
    bool rebuild_due() const { return rebuild_ || misplaced_ > 0 || dirty_.size() > 0; }
    /// Keyframes that are kept and not in the tree yet.
    std::size_t waiting() const;
    /// Keyframes in the tree, frozen ones included.
    std::size_t keyframes_in_tree() const;

    /// The tree as of the last flush() or tidy().
    const ::octomap::OcTree& tree() const { return *tree_; }
    /// Sizes of the tree as of the last flush() or tidy().
    OctomapSizes sizes() const { return sizes_of(*tree_); }
    /// The bytes of a .bt file: maximum likelihood, pruned.
    std::string bt() const { return bt_of(*tree_); }
    /// The same with the occupied space only.
    std::string bt_occupied() const { return bt_occupied_of(*tree_); }
    /// The bytes of an .ot file.
    std::string ot() const { return ot_of(*tree_); }
    /// Centres of all occupied cells of the smallest leaf's size, world frame, metres.
    std::vector<Eigen::Vector3d> occupied_voxels() const;

    /// Points of a voxel cloud: number of voxels of the given edge that hold at least one point of the kept
    /// depth images at their newest poses.
    std::size_t voxel_cloud_size(double voxel_m) const;

    /// Bytes of the depth images kept for rebuilding.
    std::size_t stored_bytes() const;
    /// What it takes to go on building: the trees (of a rebuild and of the frozen keyframes too), the depth
    /// images kept and the scratch memory of a scan. A walk over the trees: not for every message.
    std::size_t working_bytes() const;
    /// Keyframes whose depth is no longer kept.
    std::size_t frozen() const { return frozen_; }
    /// How often the tree was rebuilt.
    std::size_t rebuilds() const { return rebuilds_; }
    /// Scans that rebuilds inserted again: what they cost.
    std::size_t reinserted() const { return reinserted_; }

  private:
    struct Keyframe {
        std::shared_ptr<const StoredScan> scan;
        Pose world_from_camera;
        std::vector<Voxel> blocks = {};  ///< that it touches in tree_
        bool inside = false;             ///< tree_ holds it
        bool misplaced =
            false;  ///< tree_ (or what the rebuild will make of it) does not hold it as it should
    };
    /// A keyframe as a rebuild takes it, whatever becomes of it meanwhile.
    struct Planned {
        int id;
        std::shared_ptr<const StoredScan> scan;
        Pose world_from_camera;
        std::vector<Voxel> blocks;  ///< that it touches, as far as is known
        bool moved = false;         ///< the blocks are those of its old place
        bool is_new = false;        ///< no block of the new tree holds it yet, the other ones neither
        bool frozen_aside = false;  ///< was frozen meanwhile, at another pose
    };
    struct Rebuild {
        std::vector<Planned> plan;  ///< ascending id
        BlockSet dirty;             ///< blocks that are built anew
        bool everything = false;    ///< all are
        std::size_t surveyed = 0, inserted = 0;
        std::unique_ptr<::octomap::OcTree> tree;  ///< null while the dirty blocks are being found
    };

    bool insert_next(const std::stop_token& stop);
    bool rebuild_next(const std::stop_token& stop);
    void begin_rebuild();
    void survey(Planned& planned, const std::stop_token& stop);
    void begin_tree(const std::stop_token& stop);
    bool is_touched(const Planned& planned) const;
    void insert_again(Planned& planned, const std::stop_token& stop);
    void end_rebuild();
    void trace(const StoredScan& scan, const Pose& world_from_camera, const std::stop_token& stop);
    bool is_full() const { return keyframes_.size() > options_.max_keyframes; }
    void freeze_oldest(const std::stop_token& stop);
    void mark_misplaced(Keyframe& keyframe);
    void mark_dirty(const std::vector<Voxel>& blocks);

    OctomapOptions options_;
    std::map<int, Keyframe> keyframes_;        ///< by id
    std::unique_ptr<::octomap::OcTree> base_;  ///< of the frozen keyframes; null while there are none
    std::unique_ptr<::octomap::OcTree> tree_;
    KeyframePoses poses_;               ///< by the trajectories
    std::optional<int> last_inserted_;  ///< highest id in tree_: higher ones are still to be inserted
    std::optional<int> last_frozen_;
    BlockSet dirty_;             ///< blocks to be built anew for keyframes that are not kept any more
    std::size_t misplaced_ = 0;  ///< of keyframes_
    std::optional<Rebuild> rebuild_;
    ScanInserter inserter_;
    bool stale_ = false;  ///< inner nodes are not up to date
    std::size_t frozen_ = 0, rebuilds_ = 0, reinserted_ = 0;
};

}  // namespace planemap::octomap
