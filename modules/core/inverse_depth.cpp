// SPDX-License-Identifier: BSD-3-Clause
#include "core/inverse_depth.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace planemap {

namespace {

constexpr float kJoinSigmas = 4;  // of a reading's inverse depth

/// `yes` where the condition holds, else `no`, without a branch: the compiler then takes several readings at
/// a time.
inline float choose(bool condition, float yes, float no) {
    const std::int32_t mask = -static_cast<std::int32_t>(condition);
    return std::bit_cast<float>((std::bit_cast<std::int32_t>(yes) & mask) |
                                (std::bit_cast<std::int32_t>(no) & ~mask));
}

/// The slope at the middle one of five readings in a line (0: none): the smaller of the steps to its two
/// neighbours, and none where they disagree about the direction. So an edge beside a surface is not taken for
/// its slope. Where a neighbour is missing, the surface goes on as it came.
inline float slope(float before2, float before, float here, float after, float after2) {
    const float came = choose((before > 0) & (before2 > 0), before - before2, 0);
    const float comes = choose((after > 0) & (after2 > 0), after2 - after, 0);
    const float b = choose(before > 0, here - before, comes), a = choose(after > 0, after - here, came);
    return choose(a * b > 0, choose(std::abs(a) < std::abs(b), a, b), 0);
}

/// Slopes of a row of readings; the others are its neighbours in the direction of the slope.
void slopes(const float* before2, const float* before, const float* here, const float* after,
            const float* after2, int count, float per_pixel, float* out) {
    for (int u = 0; u < count; ++u)
        out[u] = per_pixel * slope(before2[u], before[u], here[u], after[u], after2[u]);
}

}  // namespace

InverseDepth::InverseDepth(const DepthImage& depth, double units_per_metre, int reach)
    : border(2 * reach),
      value(depth.width + 2 * border, depth.height + 2 * border),
      along_u(value.width, value.height),
      along_v(value.width, value.height) {
    const auto units = static_cast<float>(units_per_metre);
    for (int v = 0; v < depth.height; ++v) {
        const std::uint16_t* from = depth.row(v);
        float* to = value.row(v + border) + border;
        for (int u = 0; u < depth.width; ++u) {
            const auto raw = static_cast<float>(from[u]);
            to[u] = choose((raw > 0) & (raw < 65535), units / raw, 0);
        }
    }
    const float per_pixel = 1 / static_cast<float>(reach);
    const std::ptrdiff_t right = reach, down = right * value.width;
    for (int v = border; v < border + depth.height; ++v) {
        const float* row = value.row(v) + border;
        slopes(row - 2 * right, row - right, row, row + right, row + 2 * right, depth.width, per_pixel,
               along_u.row(v) + border);
        slopes(row - 2 * down, row - down, row, row + down, row + 2 * down, depth.width, per_pixel,
               along_v.row(v) + border);
    }
}

Joints::Joints(const InverseDepth& depth, const CameraInfo& camera)
    : right(depth.value.width, depth.value.height), below(depth.value.width, depth.value.height) {
    const InverseDepthNoise noise(camera);
    const int count = depth.value.width - 2 * depth.border;
    // Of a row of readings with the ones beside or below them.
    const auto join = [=](const float* here, const float* slope_here, const float* next,
                          const float* slope_next, std::uint8_t* joined) {
        for (int u = 0; u < count; ++u) {
            const float gap = std::abs(here[u] + 0.5f * slope_here[u] - (next[u] - 0.5f * slope_next[u]));
            joined[u] = (here[u] > 0) & (next[u] > 0) & (gap <= kJoinSigmas * noise.sigma(here[u]));
        }
    };
    for (int v = depth.border; v + depth.border < right.height; ++v) {
        const float* row = depth.value.row(v) + depth.border;
        const float *along_u = depth.along_u.row(v) + depth.border,
                    *along_v = depth.along_v.row(v) + depth.border;
        join(row, along_u, row + 1, along_u + 1, right.row(v) + depth.border);
        join(row, along_v, row + right.width, along_v + right.width, below.row(v) + depth.border);
    }
}

}  // namespace planemap
