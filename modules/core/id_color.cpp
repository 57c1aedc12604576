// SPDX-License-Identifier: BSD-3-Clause
#include "core/id_color.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace planemap {

Rgb id_color(int id) {
    // Hues a golden angle apart, in three shades: neighbouring ids never look alike.
    const double hue = std::fmod(id * 0.6180339887498949, 1.0) + (id < 0 ? 1 : 0);
    const double value = std::array{0.92, 0.78, 0.85}[static_cast<std::size_t>(std::abs(id % 3))];
    const auto channel = [&](double offset) {
        const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (hue - offset));
        return static_cast<std::uint8_t>(std::lround(255 * value * (0.42 + 0.58 * wave)));
    };
    return {channel(0), channel(1.0 / 3), channel(2.0 / 3)};
}

}  // namespace planemap
