// SPDX-License-Identifier: BSD-3-Clause
// What a keyframe saw goes over to those that stay when the graph lets it go.
#pragma once

#include <functional>
#include <vector>

#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// Hands the regions of a keyframe that goes to those near it, all with the poses that they are in the map
/// with; give the nearest first, and regions that know their planes. Where the heirs saw (nearly) all of what
/// a region covers of its plane, its points join the region of that plane that lies nearest to it, and its
/// outline goes; else, or where none lies within agreement_m of it (what is before a cupboard is no view of
/// the cupboard, although both may be one plane of the map), the region moves to the nearest heir as it is.
/// No point is lost, and no surface. Precondition: at least one heir; every keyframe has a pose.
void hand_over(const StoredKeyframe& gone, const std::vector<StoredKeyframe*>& heirs,
               const std::function<double(const StoredRegion&)>& agreement_m);

/// The same for what it saw past, and for the looks from near it: they are looks from near the nearest heir
/// then. Its own view is left out where it says nothing else than the heir's.
void hand_over_looks(StoredKeyframe gone, StoredKeyframe& heir);

}  // namespace planemap::map
