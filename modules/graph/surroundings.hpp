// SPDX-License-Identifier: BSD-3-Clause
// Two rooms may be alike to the last poster; what was seen on the way to them rarely is.
#pragma once

#include <span>

#include "graph/verification_options.hpp"
#include "places/keyframe_view.hpp"

namespace planemap::graph {

/// A view and where its camera stood, if a loop closure is true.
struct SurroundingView {
    const places::KeyframeView* view = nullptr;
    Pose world_from_camera = Pose::Identity();
    double drift_m = 0;  ///< bound of its error with respect to its own end of the loop closure
};

/// Pairs of views, one from about either end of a loop closure, that would look at the same.
struct Surroundings {
    int alike = 0;   ///< pairs that show the same points
    int unlike = 0;  ///< pairs of which one saw through the other's planes, or that share no point
    /// Identical rooms are alike in most pairs, so that a few which are not count more.
    bool fit() const { return unlike < 2 || 6 * unlike <= alike; }
};

/// Compares each of the newer views with the older one that shares most with it. Pairs that drift allows to
/// be elsewhere, or that show little, count as neither.
Surroundings compare_surroundings(std::span<const SurroundingView> older,
                                  std::span<const SurroundingView> newer,
                                  const places::VerificationOptions& options);

}  // namespace planemap::graph
