// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "graph/keyframes.hpp"
#include "graph/options.hpp"
#include "graph/topology.hpp"
#include "places/place_index.hpp"
#include "places/verification.hpp"

namespace planemap::graph {

/// Looks for keyframes that saw what the newest one sees. Which are tried, and what a loop closure must stand
/// up to, is decided here; it changes nothing.
class LoopSearch {
  public:
    /// The options must be valid.
    explicit LoopSearch(const GraphOptions& options) : options_(options) {}

    /// The newest keyframe's view, before it is asked for.
    void add(const places::KeyframeView& view) { place_of_.push_back(index_.add(view.descriptors)); }
    /// A keyframe goes: the numbers of later ones become less by one.
    void remove(int node, const places::KeyframeView& view);

    /// Nodes that are worth to be verified, the best first: those that look like the newest one, then those
    /// that should see the same from where they stand. `drifts` is how far odometry may have gone astray
    /// between the newest and each node. Nodes that odometry leads to in a few steps are left out, they see
    /// the same anyway.
    std::vector<int> candidates(const Keyframes& keyframes, const Topology& topology,
                                const std::vector<Drift>& drifts) const;

    /// The loop closure from a node to the newest one, if their views agree, neither odometry nor what was
    /// seen around them speaks against it, and, where odometry leaves that open, no other node explains the
    /// newest view from elsewhere.
    std::optional<places::Verification> verified(int node, const Keyframes& keyframes,
                                                 const Topology& topology,
                                                 const std::vector<Drift>& drifts) const;

    std::size_t memory_bytes() const { return index_.memory_bytes(); }

  private:
    std::vector<double> appearance_scores(const places::KeyframeView& view,
                                          const std::vector<bool>& near) const;
    std::vector<double> place_scores(const Keyframes& keyframes, const std::vector<bool>& near,
                                     const std::vector<Drift>& drifts) const;
    std::optional<places::Verification> closure(int node, const Keyframes& keyframes,
                                                const Topology& topology, const std::vector<Drift>& drifts,
                                                const places::VerificationOptions& options) const;
    bool has_rival(int node, const Keyframes& keyframes, const Topology& topology,
                   const std::vector<Drift>& drifts, const places::Verification& found) const;
    bool is_seen_elsewhere(int node, const Keyframes& keyframes, const Topology& topology,
                           const places::Verification& found) const;
    bool fits_odometry(const Pose& expected, const Drift& drift, const Pose& node_from_newest) const;
    bool fits_surroundings(int node, const Keyframes& keyframes, const Topology& topology,
                           const std::vector<Drift>& drifts, const Pose& node_from_newest) const;

    GraphOptions options_;
    places::PlaceIndex index_;
    std::vector<int> place_of_;  ///< number in the index of each node
};

}  // namespace planemap::graph
