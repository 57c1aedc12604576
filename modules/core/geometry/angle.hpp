// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace planemap {

/// Radians are what all interfaces take; degrees are for people: options and printed figures (suffix _deg).
constexpr double degrees(double radians) {
    return radians * (180 / std::numbers::pi);
}
constexpr double radians(double degrees) {
    return degrees * (std::numbers::pi / 180);
}

}  // namespace planemap
