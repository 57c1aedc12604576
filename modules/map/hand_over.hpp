// SPDX-License-Identifier: BSD-3-Clause
// What a keyframe saw goes over to those that stay when the graph lets it go.
#pragma once

#include <vector>

#include "map/stored_keyframe.hpp"

namespace planemap {

/// Hands the regions of a keyframe that goes to those near it, all with the poses that they are in the map
/// with; give the nearest first, and regions that know their planes. Where the heirs saw (nearly) all of what
/// a region covers of its plane, its points join the nearest one's region of that plane, and its outline goes
/// with it; else the region moves to the nearest heir as it is. No point is lost, and no surface.
/// Precondition: at least one heir; every keyframe has a pose.
void hand_over(const StoredKeyframe& gone, const std::vector<StoredKeyframe*>& heirs);

}  // namespace planemap
