// SPDX-License-Identifier: BSD-3-Clause
// Which keyframes a graph takes in.
#pragma once

#include <optional>

#include "core/keyframe.hpp"

namespace planemap::graph {

/// A keyframe's id is the next one, or a few later: up to 10,000 may be missing. A later one than that is a
/// mistake, or another odometry's.
bool follows(int id, int last_id);

/// Throws std::invalid_argument that names every bad field of a keyframe: an id that does not follow the last
/// one's (if there is one), values that are not finite, poses that are not rigid or further away than
/// anything is, regions that are not valid. Its covariance may be anything.
void check(const Keyframe& keyframe, std::optional<int> last_id);

}  // namespace planemap::graph
