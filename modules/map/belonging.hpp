// SPDX-License-Identifier: BSD-3-Clause
// Whether regions belong to the planes that they joined, asked again once these are fitted.
#pragma once

#include <cstddef>
#include <vector>

#include "map/plane_set.hpp"
#include "map/region_joiner.hpp"
#include "map/surfaces.hpp"

namespace planemap::map {

/// Evicts regions that lie off the plane that they joined, as it is fitted to all of them (RMS over the
/// region), by more than the merging rules and `rules.sigmas` of poses and depth allow, where another plane
/// is within that; and those that are off by more than their noise, where another plane is twice as near.
/// They join the one that they fit best. A region that fits no other plane stays: a plane of its own would
/// say the surface twice. Planes that lost some are made anew of what is left, and those that have come to
/// satisfy the merging rules are merged. Then all are asked again, until nothing changes, four times at most.
/// The regions `seen` are asked in that `order`; their planes follow. The first `fixed` planes hold more than
/// their regions: nothing is evicted from them. Returns for each plane where it is now, or PlaneSet::none()
/// where nothing is left of it.
std::vector<std::size_t> reassign_strays(PlaneSet& planes, std::vector<SeenRegion>& seen,
                                         const std::vector<std::size_t>& order, std::size_t fixed,
                                         RegionJoiner& joiner, const SurfaceRules& rules);

}  // namespace planemap::map
