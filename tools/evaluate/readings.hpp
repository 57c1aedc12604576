// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap::evaluation {

/// True for a reading that figures are counted over: valid, and within the sensor's trusted range.
inline bool is_trusted(std::uint16_t raw, const CameraInfo& camera) {
    const double z = camera.metres(raw);
    return is_valid_depth(raw) && z >= camera.depth_min_m && z <= camera.depth_max_m;
}

/// Calls visit(u, v, z) for each trusted reading, row by row; z in metres.
template <typename Visit>
void for_each_reading(const DepthImage& depth, const CameraInfo& camera, const Visit& visit) {
    for (int v = 0; v < depth.height; ++v)
        for (int u = 0; u < depth.width; ++u)
            if (is_trusted(depth(u, v), camera)) visit(u, v, camera.metres(depth(u, v)));
}

}  // namespace planemap::evaluation
