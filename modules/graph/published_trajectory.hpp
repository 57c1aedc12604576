// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/geometry/union_find.hpp"
#include "core/trajectory.hpp"
#include "graph/keyframes.hpp"
#include "graph/options.hpp"

namespace planemap::graph {

/// The graph as others see it: where its keyframes stand, and a revision that counts how often some of them
/// moved by more than revision_m or revision_rad. Moves too small for that add up until they are not.
class PublishedTrajectory {
  public:
    /// The options must be valid.
    explicit PublishedTrajectory(const GraphOptions& options) : options_(options) {}

    const KeyframeTrajectory& get() const { return trajectory_; }

    /// Brings it up to date with keyframes that moved, or of which one was added since. `parts` says which
    /// hang together. Precondition: at least one.
    void update(const Keyframes& keyframes, UnionFind<int> parts, int loop_closures);
    /// A keyframe goes.
    void remove(int node);

  private:
    bool has_moved(const std::vector<Pose>& poses) const;

    GraphOptions options_;
    KeyframeTrajectory trajectory_;
    std::vector<Pose> revision_poses_;  ///< of the keyframes when they last made a revision
};

}  // namespace planemap::graph
