// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/packed_outline.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace planemap {

float pack(const Outline& outline, std::vector<std::int16_t>& packed) {
    constexpr double kMaxSteps = 32767;
    double largest = 0;
    std::size_t size = 0;
    for (const Ring& ring : outline.rings) {
        if (ring.size() > kMaxRingVertices)
            throw std::length_error("an outline ring of " + std::to_string(ring.size()) + " vertices");
        size += 1 + 2 * ring.size();
        for (const Eigen::Vector2d& v : ring) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    }
    const auto unit = static_cast<float>(std::max(kOutlineStep_m, largest / kMaxSteps));
    if (packed.empty()) packed.reserve(size);  // behind others, room for exactly one more would copy them all
    const auto steps = [&](double metres) {
        return static_cast<std::int16_t>(
            std::clamp(std::round(metres / static_cast<double>(unit)), -kMaxSteps, kMaxSteps));
    };
    for (const Ring& ring : outline.rings) {
        packed.push_back(static_cast<std::int16_t>(ring.size()));
        for (const Eigen::Vector2d& v : ring) packed.insert(packed.end(), {steps(v.x()), steps(v.y())});
    }
    return unit;
}

}  // namespace planemap
