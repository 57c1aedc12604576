// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace planemap {

/// A row-major image without padding. Pixel centres are at integers: pixel (u, v) is column u, row v.
template <typename T>
struct Image {
    int width = 0, height = 0;
    std::vector<T> pixels;

    Image() = default;
    Image(int w, int h, T fill = T{})
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

    bool empty() const { return pixels.empty(); }
    T* row(int v) { return pixels.data() + static_cast<std::ptrdiff_t>(v) * width; }
    const T* row(int v) const { return pixels.data() + static_cast<std::ptrdiff_t>(v) * width; }
    T& operator()(int u, int v) { return row(v)[u]; }
    const T& operator()(int u, int v) const { return row(v)[u]; }
    bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
};

/// Depth along the optical axis in the sensor's own units (CameraInfo::depth_units_per_metre); 0 and 65535
/// are invalid.
using DepthImage = Image<std::uint16_t>;
/// Luma.
using GrayImage = Image<std::uint8_t>;

struct Rgb {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb&, const Rgb&) = default;
};
using RgbImage = Image<Rgb>;

/// True for a depth reading that means a distance.
constexpr bool is_valid_depth(std::uint16_t raw) {
    return raw != 0 && raw != 65535;
}

}  // namespace planemap
