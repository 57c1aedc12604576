// SPDX-License-Identifier: BSD-3-Clause
// Outlines in whole steps of 16 bits: 4 bytes a vertex. For each ring its number of vertices, then their x, y
// in steps, ring after ring.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/outline.hpp"

namespace planemap {

/// A step, metres, for outlines that reach up to 32 m from their origin.
inline constexpr double kOutlineStep_m = 0.001;
/// What a ring's packed size can say.
inline constexpr std::size_t kMaxRingVertices = 32767;

/// Appends the outline, rounded to steps of 1 mm (an error of at most 0.71 mm), or coarser ones if it reaches
/// further than 32 m. Returns the step, metres. Throws std::length_error for a ring of over kMaxRingVertices.
float pack(const Outline& outline, std::vector<std::int16_t>& packed);

/// Calls ring(size) at the start of each ring and vertex(x, y) for each of its vertices, in steps.
template <typename OnRing, typename OnVertex>
void for_each_packed(std::span<const std::int16_t> packed, const OnRing& ring, const OnVertex& vertex) {
    for (std::size_t i = 0; i < packed.size();) {
        const auto size = static_cast<std::size_t>(packed[i++]);
        ring(size);
        for (const std::size_t end = i + 2 * size; i < end; i += 2) vertex(packed[i], packed[i + 1]);
    }
}

}  // namespace planemap
