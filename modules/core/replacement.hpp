// SPDX-License-Identifier: BSD-3-Clause
// What becomes of keyframes that the graph lets go.
#pragma once

#include <vector>

#include "core/keyframe.hpp"

namespace planemap {

/// A keyframe that a trajectory no longer names, and where it stood, seen from one that is still named.
struct Replacement {
    int id = -1;
    int by = -1;
    Pose by_from_id = Pose::Identity();
};

/// The keyframes that a trajectory names and the next one does not, each with the nearest of those that both
/// name (a radian counts as a metre), as they stood in the first. None when they share no keyframe: then the
/// second is another graph's, and says nothing about the first.
std::vector<Replacement> replacements(const std::vector<KeyframePose>& before,
                                      const std::vector<KeyframePose>& now);

}  // namespace planemap
