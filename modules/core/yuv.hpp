// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/image.hpp"

namespace planemap {

/// A colour of ITU-R BT.601, full range: y, u and v of 0 to 255, u and v about 128. What no pixel can show is
/// the nearest that one can.
inline Rgb rgb_of_yuv(double y, double u, double v) {
    const auto byte = [](double value) {
        return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    };
    return {byte(y + 1.402 * (v - 128)), byte(y - 0.344136 * (u - 128) - 0.714136 * (v - 128)),
            byte(y + 1.772 * (u - 128))};
}

}  // namespace planemap
