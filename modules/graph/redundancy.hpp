// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "graph/keyframes.hpp"
#include "graph/options.hpp"
#include "graph/topology.hpp"

namespace planemap::graph {

/// Finds the keyframes that newer ones of the same place make redundant. The older goes, so that the graph
/// knows the place as it is now. Nothing goes here: the graph may find that a keyframe has nobody to hand its
/// ties to.
class Redundancy {
  public:
    /// The options must be valid.
    explicit Redundancy(const GraphOptions& options) : options_(options) {}

    /// The next keyframe about whose place nobody asked yet, oldest first, once it is no longer among the
    /// newest, which odometry may still name.
    std::optional<int> next(const Keyframes& keyframes) const;

    /// Ids of the keyframes about where this one stands that look like max_alike newer ones, and of the
    /// oldest beyond max_place in all. Ask once of each that next() gives: it counts whom the others look
    /// like.
    std::vector<int> about(int node, const Keyframes& keyframes, const Topology& topology);

    /// A keyframe has gone.
    void forget(int id) { alike_.erase(id); }

  private:
    std::vector<int> place_of(int node, const Keyframes& keyframes, const Topology& topology) const;
    bool is_alike(int a, int b, const Keyframes& keyframes) const;

    GraphOptions options_;
    int asked_up_to_ = -1;                   ///< id of the newest keyframe that about() was asked of
    std::map<int, std::vector<int>> alike_;  ///< by id, ids of newer ones of its place that look like it
};

}  // namespace planemap::graph
