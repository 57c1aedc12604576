// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/scene.hpp"

namespace planemap::scene {

/// A wall of 2 x 1 m three metres ahead, with a hole, a little turned, and a small plate a metre before it.
inline std::vector<PlanarRegion> two_regions() {
    const Rectangle wall{
        facing({0, 0, 3}, {0.2, 0.1, -1}, {1, 0, 0}), 1, 0.5, {rectangle_ring(-0.3, -0.2, 0.1, 0.2)}};
    const Rectangle plate{facing({0.5, 0.1, 2}, {0, 0, -1}, {1, 0, 0}), 0.25, 0.2, {}};
    return {region_of(wall, Pose::Identity(), 0.02, 0.004), region_of(plate, Pose::Identity(), 0.02, 0.004)};
}

}  // namespace planemap::scene
