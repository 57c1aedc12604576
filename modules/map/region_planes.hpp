// SPDX-License-Identifier: BSD-3-Clause
// Which planes the regions of keyframes are part of, as the map tells others and as it is told again.
#pragma once

#include <cstdint>

#include "core/surfaces.hpp"
#include "map/keyframe_store.hpp"
#include "map/planes.hpp"

namespace planemap::map {

/// StoredRegion::plane of the keyframes with a pose, by their regions' numbers; `utime` is the map's.
Surfaces surfaces_of(const KeyframeStore& keyframes, std::int64_t utime);

/// Says of all regions which planes they were part of for another mapper with the same keyframes: those that
/// `surfaces` does not name, of none. A rebuild then gives planes these ids, and no new plane takes one.
void recall_surfaces(const Surfaces& surfaces, KeyframeStore& keyframes, Planes& planes);

}  // namespace planemap::map
