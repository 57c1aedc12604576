// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/decimation.hpp"

namespace planemap::benchmark {

DepthImage decimated(const DepthImage& depth, int step) {
    DepthImage out((depth.width + step - 1) / step, (depth.height + step - 1) / step);
    for (int v = 0; v < out.height; ++v) {
        const std::uint16_t* from = depth.row(v * step);
        std::uint16_t* to = out.row(v);
        for (int u = 0; u < out.width; ++u) to[u] = from[static_cast<std::ptrdiff_t>(u) * step];
    }
    return out;
}

CameraInfo decimated(const CameraInfo& camera, int step) {
    const auto scaled = [&](const PinholeCamera& c) {
        return PinholeCamera{(c.width + step - 1) / step,
                             (c.height + step - 1) / step,
                             c.fx / step,
                             c.fy / step,
                             c.cx / step,
                             c.cy / step};
    };
    CameraInfo out = camera;
    out.depth = scaled(camera.depth);
    out.color = scaled(camera.color);
    return out;
}

}  // namespace planemap::benchmark
