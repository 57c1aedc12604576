// SPDX-License-Identifier: BSD-3-Clause
// What joins the nodes of a graph, and how a node that goes hands it on.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "graph/optimisation.hpp"
#include "graph/options.hpp"

namespace planemap::graph {

/// How far odometry may have gone astray between two keyframes.
struct Drift {
    double metres = std::numeric_limits<double>::infinity();
    double radians = std::numeric_limits<double>::infinity();

    double size() const { return metres + radians; }
    Drift operator+(const Drift& other) const { return {metres + other.metres, radians + other.radians}; }
};

/// An edge of the graph with what is known of it.
struct Tie {
    PoseEdge edge;
    Drift drift;
    int measurements = 1;       ///< that it is made of, as far as they count
    bool is_step = false;       ///< odometry from one keyframe to the next, as it came
    std::int64_t closure = -1;  ///< number of the loop closure that it came from; -1: none
    double weight = 1;          ///< of a loop closure in the last optimisation; near 0: let go of
    bool is_known = true;       ///< an optimisation knows it, or is at work on it
    bool is_applied = true;     ///< the poses follow it

    bool touches(int node) const { return edge.from == node || edge.to == node; }
    int other(int node) const { return edge.from == node ? edge.to : edge.from; }
};

/// The covariance of a step (translation, rotation), together with what is known of any camera in a building:
/// that in so many seconds it goes no further than at some speed, 1 m/s and 1 rad/s (one sigma), from where
/// it is said to be. Where odometry saw nothing of a direction its covariance has no end, and planes that are
/// parallel but for their noise would bend the graph along it. Not finite, or no time: as it is.
Matrix6d within_reach(const Matrix6d& covariance, double seconds);

/// Odometry's measurement: the step, with its covariance, leads from node `from` to node `to`. `detour` is
/// how far it may be off besides, when the keyframe that odometry named has gone and another stands for it.
Tie odometry_tie(const GraphOptions& options, int from, int to, const Pose& step, const Matrix6d& covariance,
                 const Drift& detour = {0, 0});

/// Odometry was lost for so long between two nodes: the step is a guess, which the camera's speed bounds.
Tie gap_tie(const GraphOptions& options, int from, int to, const Pose& step, double seconds);

/// A loop closure of this number that no optimisation knows yet.
Tie loop_tie(const GraphOptions& options, int from, int to, const Pose& from_from_to,
             const Matrix6d& covariance, std::int64_t closure);

/// The same measurement read from its other end.
PoseEdge reversed(const PoseEdge& edge);

/// The tie of a node that goes, in the hands of its keeper, to which `to_keeper` ties it: from the keeper to
/// the node at the tie's other end. It is as uncertain as both together, and at the given poses it pulls that
/// node as much as before: where the poses were at their optimum, they still are, and of a chain nothing is
/// lost (its marginal is this very edge). Precondition: both ties touch `gone`.
Tie handed_over(const Tie& tie, const Tie& to_keeper, int gone, const std::vector<Pose>& poses);

/// Takes a second measurement of the same nodes into a tie; both count by their information. Of many
/// measurements, the sum counts as much as four of them: what is measured again and again in one place errs
/// alike, and what is measured there tomorrow must still count. Precondition: the same two nodes.
void fuse(Tie& tie, const Tie& other, const std::vector<Pose>& poses);

/// Lets a node go: its ties go over to `keeper`, and those that then join the same nodes become one. Ties
/// between the two end with it, and so do loop closures that no optimisation believes in. Ties of nodes with
/// higher numbers are renumbered by one. `poses` are those before that.
void hand_over(std::vector<Tie>& ties, const Tie& to_keeper, int gone, const std::vector<Pose>& poses);

constexpr double kDistrusted = 0.05;  ///< weight of a loop closure that counts as wrong

}  // namespace planemap::graph
