// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/union_find.hpp"
#include "graph/node_index.hpp"
#include "graph/ties.hpp"

namespace planemap::graph {

/// Which nodes of a graph are tied to which, and by what: odometry, loop closures, and gaps, where odometry
/// was lost and only the camera's speed says how far apart two nodes are. Where the nodes stand is not its
/// business: `poses` below are world_from_camera of each.
class Topology {
  public:
    /// Adds a node without ties; its number is the one after the last.
    void add_node() { links_.emplace_back(); }
    void add_odometry(const Tie& tie);
    void add_gap(const Tie& tie);
    void add_loop(const Tie& tie);

    int size() const { return static_cast<int>(links_.size()); }
    const std::vector<Tie>& loops() const { return loops_; }

    /// Sets of nodes that odometry and loop closures tie to each other.
    UnionFind<int> parts() const;

    /// What an optimisation minimises: all edges; of the gaps only those across which nothing else ties the
    /// parts. To start with, loop closures that counted as wrong are left out, and new ones are beyond doubt.
    std::vector<PoseEdge> edges(bool to_start_with) const;

    /// Least drift from a node to each other one (Dijkstra), along what the poses follow: not by a loop
    /// closure that the last optimisation did not know, or let go of.
    std::vector<Drift> drifts_from(int source) const;

    /// Marks the nodes that less than `steps` steps of odometry lead to, the node itself included.
    std::vector<bool> within_steps(int node, int steps) const;

    /// The tie to the nearest of the nodes that are tied to this one beyond doubt, if there is one.
    std::optional<Tie> nearest_trusted(int node, const std::vector<Pose>& poses) const;

    /// Whether a loop closure of the node is one that the poses do not follow yet.
    bool has_unapplied_loop(int node) const;
    /// Whether there are loop closures that no optimisation knows.
    bool has_new_loops() const;
    /// Largest whitened error of these; 0 without any.
    double worst_new_loop(const std::vector<Pose>& poses) const;
    /// The edges of these.
    std::vector<PoseEdge> new_loops() const;
    /// An optimisation is at work with all loop closures that there are.
    void mark_known();
    /// The poses are those of an optimisation that knew the first `known` loop closures: weighs all of them
    /// by how well they fit, with a Cauchy kernel of this width (standard deviations).
    void weigh(std::size_t known, const std::vector<Pose>& poses, double kernel_width);

    /// Lets a node go; its ties go over to the other node of `to_keeper`, see hand_over(). `poses` are
    /// those before that.
    void hand_over(const Tie& to_keeper, int gone, const std::vector<Pose>& poses);

    std::size_t memory_bytes() const;

  private:
    /// A tie as seen from one of its nodes.
    struct Link {
        int other = -1;
        Drift drift;
        bool is_step = false;
        int loop = -1;  ///< index of the loop closure; -1: none
    };

    void link(const Tie& tie, int loop = -1);
    bool holds(const Link& link) const;

    std::vector<Tie> odometry_, loops_, gaps_;
    std::vector<std::vector<Link>> links_;  ///< of each node
};

}  // namespace planemap::graph
