// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose.hpp"
#include "graph/node_index.hpp"
#include "places/keyframe_view.hpp"

namespace planemap::graph {

/// A keyframe in the graph.
struct KeyframeNode {
    int id = -1;
    std::int64_t utime = 0;
    int chain = -1;  ///< Keyframe::chain
    Pose odom_from_camera = Pose::Identity();
    places::KeyframeView view;
};

/// The keyframes of a graph, numbered without gaps by ascending id, and where they stand. Numbers change when
/// one goes, ids never do.
class Keyframes {
  public:
    bool empty() const { return nodes_.empty(); }
    int size() const { return static_cast<int>(nodes_.size()); }
    /// Number of the newest; -1 for none.
    int newest() const { return size() - 1; }
    const KeyframeNode& operator[](int node) const { return nodes_[at(node)]; }
    const KeyframeNode& back() const { return nodes_.back(); }

    /// world_from_camera of each node.
    const std::vector<Pose>& poses() const { return poses_; }
    const Pose& pose(int node) const { return poses_[at(node)]; }
    /// The pose of b in a's camera frame, a_from_b.
    Pose between(int a, int b) const { return pose(a).inverse(Eigen::Isometry) * pose(b); }
    /// The number of a keyframe, -1 if there is none of this id.
    int node_of(int id) const;
    /// The newest of a chain of odometry, -1 if there is none.
    int newest_of_chain(int chain) const;

    /// Adds the newest. It hangs on the node by which it was placed (-1: none): until an optimisation knows
    /// it, it follows that one. Precondition: a higher id than all others.
    void add(KeyframeNode node, const Pose& world_from_camera, int parent);

    /// Moves the nodes marked in `moving` as one: `move` maps the world to the world.
    void carry(const std::vector<bool>& moving, const Pose& move);

    /// Takes the poses that an optimisation found for the oldest nodes; those after them follow the ones they
    /// hang on. Returns how the world moved about each node.
    std::vector<Pose> follow(const std::vector<Pose>& optimised);

    /// Removes a node; what hung on it hangs on its keeper. Not the first one, and not while an optimisation
    /// is at work: that knows nodes by their numbers.
    void remove(int node, int keeper);

    std::size_t memory_bytes() const;

  private:
    std::vector<KeyframeNode> nodes_;  ///< ascending id
    std::vector<Pose> poses_;          ///< world_from_camera of each
    std::vector<int> parents_;         ///< node that each was placed by; -1 for the first
};

}  // namespace planemap::graph
