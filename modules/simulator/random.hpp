// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that depend on their index only, so that a frame is the same in whatever order frames are
// drawn.
#pragma once

#include <array>
#include <cstdint>

namespace planemap::simulator {

/// A well-mixed 64-bit value of any 64-bit value (splitmix64's finaliser).
constexpr std::uint64_t mix(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// A value of several indices.
template <typename... Rest>
constexpr std::uint64_t mix(std::uint64_t first, std::uint64_t second, Rest... rest) {
    return mix(mix(first) ^ second, static_cast<std::uint64_t>(rest)...);
}

/// In [0, 1), from the upper bits.
constexpr double uniform(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}
constexpr double uniform(std::uint64_t bits, double low, double high) {
    return low + (high - low) * uniform(bits);
}

/// Quantiles of the standard normal distribution, so that 12 random bits give one sample (within 3.7 sigma).
class GaussianTable {
  public:
    static constexpr std::uint64_t kMask = 4095;

    GaussianTable();
    float operator[](std::uint64_t bits) const { return values_[bits & kMask]; }

  private:
    std::array<float, kMask + 1> values_;
};

}  // namespace planemap::simulator
