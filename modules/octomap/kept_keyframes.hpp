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

/// A keyframe whose depth is kept, and how the tree holds it.
struct KeptKeyframe {
    std::shared_ptr<const StoredScan> scan;
    Pose world_from_camera;
    std::vector<Voxel> blocks = {};  ///< that it touches in the tree
    bool inside = false;             ///< the tree holds it
    bool misplaced = false;  ///< the tree (or what a rebuild will make of it) does not hold it as it should
};

/// The keyframes whose depth is kept, each where the newest trajectory has it. Scans enter the tree by
/// ascending id: those above the last that entered wait for it; one that comes later, or that moved since it
/// entered, is misplaced until a rebuild takes it.
class KeptKeyframes {
  public:
    using ById = std::map<int, KeptKeyframe>;

    /// Precondition: the options are valid.
    explicit KeptKeyframes(const OctomapOptions& options)
        : moved_m_(options.moved_m), moved_deg_(options.moved_deg) {}

    /// A known id replaces the earlier one. False, and nothing is taken, for an invalid pose or an id that is
    /// not above all that were let go.
    bool keep(int id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera);
    /// Moves those that the trajectory moved by more than the options allow; see OctomapBuilder::update().
    void move(const KeyframeTrajectory& trajectory);

    const ById& all() const { return keyframes_; }
    bool holds(int id) const { return keyframes_.contains(id); }
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
    std::size_t voxel_cloud_size(double voxel_m, int subsample) const;

    /// The next to enter the tree, null when none waits. Whoever inserts it says so by enter().
    const ById::value_type* next_waiting() const;
    /// The tree holds this one now, where it stands, in these blocks. Here and below, `id` is one that is
    /// kept.
    void enter(int id, std::vector<Voxel> blocks);
    /// A rebuild takes in all that is misplaced.
    void take_misplaced();
    /// A rebuilt tree holds this one, in these blocks.
    void rebuilt(int id, std::vector<Voxel> blocks);
    /// Lets the oldest go; its id and those below are never kept again. Precondition: there is one.
    std::pair<int, KeptKeyframe> let_oldest_go();

  private:
    ById::const_iterator first_waiting() const;
    void mark_misplaced(KeptKeyframe& keyframe);

    double moved_m_, moved_deg_;
    ById keyframes_;
    KeyframePoses poses_;              ///< by the trajectories
    std::optional<int> last_entered_;  ///< highest id in the tree
    std::optional<int> last_gone_;
    std::size_t misplaced_ = 0;
};

}  // namespace planemap::octomap
