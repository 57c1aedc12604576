// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/keyframe.hpp"
#include "core/replacement.hpp"
#include "octomap/options.hpp"
#include "octomap/stored_scan.hpp"
#include "octomap/voxel_set.hpp"

namespace planemap::octomap {

/// Which depth image: a keyframe's own, or the n-th of the looks that came after it. In order of time.
struct ScanId {
    int keyframe = -1, look = 0;

    ScanId(int keyframe_id) : keyframe(keyframe_id) {}  // NOLINT(google-explicit-constructor): it is one
    ScanId(int keyframe_id, int look_number) : keyframe(keyframe_id), look(look_number) {}
    friend bool operator==(const ScanId&, const ScanId&) = default;
    friend bool operator<(const ScanId& a, const ScanId& b) {
        return std::pair(a.keyframe, a.look) < std::pair(b.keyframe, b.look);
    }
    friend bool operator>(const ScanId& a, const ScanId& b) { return b < a; }
    friend bool operator<=(const ScanId& a, const ScanId& b) { return !(b < a); }
    friend bool operator>=(const ScanId& a, const ScanId& b) { return !(a < b); }
};

/// Where a depth image was taken: about a keyframe, with which it moves.
struct ScanAnchor {
    int keyframe_id = -1;
    Pose keyframe_from_camera = Pose::Identity();
};

/// A keyframe, or a look, whose depth is kept, and how the tree holds it.
struct KeptKeyframe {
    std::shared_ptr<const StoredScan> scan;
    Pose world_from_camera;
    ScanAnchor anchor;
    std::vector<Voxel> blocks = {};  ///< that it touches in the tree
    bool inside = false;             ///< the tree holds it
    bool misplaced = false;  ///< the tree (or what a rebuild will make of it) does not hold it as it should
};

/// The keyframes whose depth is kept, each where the newest trajectory has it. Scans enter the tree by
/// ascending id: those above the last that entered wait for it; one that comes later, or that moved since it
/// entered, is misplaced until a rebuild takes it.
class KeptKeyframes {
  public:
    using ById = std::map<ScanId, KeptKeyframe>;

    /// Precondition: the options are valid.
    explicit KeptKeyframes(const OctomapOptions& options)
        : moved_m_(options.moved_m), moved_deg_(options.moved_deg) {}

    /// A known id replaces the earlier one. False, and nothing is taken, for an invalid pose or an id that is
    /// not above all that were let go.
    bool keep(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
              const ScanAnchor& anchor);
    /// A keyframe's own.
    bool keep(int keyframe_id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera) {
        return keep(keyframe_id, std::move(scan), world_from_camera, {keyframe_id, Pose::Identity()});
    }
    /// Moves those that the trajectory moved by more than the options allow; see OctomapBuilder::update().
    void move(const KeyframeTrajectory& trajectory);

    const ById& all() const { return keyframes_; }
    bool holds(ScanId id) const { return keyframes_.contains(id); }
    std::size_t size() const { return keyframes_.size(); }
    std::size_t misplaced() const { return misplaced_; }
    /// How many wait to enter the tree.
    std::size_t waiting() const;
    /// How many the tree holds.
    std::size_t inside() const;
    /// True when the oldest does not wait for the tree.
    bool has_oldest_entered() const;
    /// Bytes of the depth images and of the lists of blocks.
    std::size_t bytes() const;
    /// Voxels of the given edge that hold a reading of every n-th pixel along u and v.
    VoxelSet voxel_cloud(double voxel_m, int subsample) const;

    /// The next to enter the tree, null when none waits. Whoever inserts it says so by enter().
    const ById::value_type* next_waiting() const;
    /// The tree holds this one now, where it stands, in these blocks. Here and below, `id` is one that is
    /// kept.
    void enter(ScanId id, std::vector<Voxel> blocks);
    /// A rebuild takes in all that is misplaced.
    void take_misplaced();
    /// A rebuilt tree holds this one, in these blocks.
    void rebuilt(ScanId id, std::vector<Voxel> blocks);
    /// Lets the oldest go; its id and those below are never kept again. Precondition: there is one.
    std::pair<ScanId, KeptKeyframe> let_oldest_go();

  private:
    ById::const_iterator first_waiting() const;
    void mark_misplaced(KeptKeyframe& keyframe);

    double moved_m_, moved_deg_;
    ById keyframes_;
    KeyframePoses poses_;                 ///< by the trajectories
    std::optional<ScanId> last_entered_;  ///< highest id in the tree
    std::optional<ScanId> last_gone_;
    std::size_t misplaced_ = 0;
};

}  // namespace planemap::octomap
