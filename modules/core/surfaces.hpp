// SPDX-License-Identifier: BSD-3-Clause
// What the map hands back to the graph: what it found to be one surface is one landmark.
#pragma once

#include <cstdint>
#include <vector>

namespace planemap {

/// Which planes of the map the regions of a keyframe are part of.
struct KeyframeSurfaces {
    int id = -1;              ///< of the keyframe
    std::vector<int> planes;  ///< id of the plane of each of Keyframe::regions; -1: of none
};

/// The same of all keyframes in a map.
struct Surfaces {
    std::int64_t utime = 0;                   ///< of the newest keyframe in the map, microseconds
    std::vector<KeyframeSurfaces> keyframes;  ///< ascending id
};

}  // namespace planemap
