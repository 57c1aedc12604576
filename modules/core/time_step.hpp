// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace planemap {

/// The median of some steps of time: of an even number, the later one of the middle two. Leaves them in
/// another order. Precondition: there is one.
inline std::int64_t median_step(std::span<std::int64_t> steps) {
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

}  // namespace planemap
