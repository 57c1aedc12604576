// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace planemap {

/// The whole number nearest to a value of at least -0.5; a half goes up. For smaller values it is wrong. It
/// costs an addition, where std::lround() is a call: for what is done to every pixel.
template <typename Whole, typename Real>
constexpr Whole nearest_whole(Real value) {
    constexpr Real kHalf = 0.5;
    return static_cast<Whole>(value + kHalf);
}

}  // namespace planemap
