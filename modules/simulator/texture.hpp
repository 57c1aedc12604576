// SPDX-License-Identifier: BSD-3-Clause
// Procedural pictures for the surfaces of a simulated world.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.hpp"

namespace planemap::simulator {

/// A colour in [0, 1], as an image stores it (gamma included).
struct Color {
    float r = 0, g = 0, b = 0;
};
inline Color operator*(float s, Color c) {
    return {s * c.r, s * c.g, s * c.b};
}
inline Color operator+(Color a, Color b) {
    return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline Color blend(Color a, Color b, float share_of_b) {
    return (1 - share_of_b) * a + share_of_b * b;
}

/// A picture with its mip levels: level k has half the width and height of level k - 1, and the last is at
/// least 2x2. A texel is r | g << 8 | b << 16.
struct Texture {
    std::vector<Image<std::uint32_t>> levels;
};

enum class Pattern {
    kPaint,    ///< bare paint: two low octaves of noise, a few marks, almost nothing to track
    kWood,     ///< grain along u
    kPlanks,   ///< a parquet of planks along u
    kBrick,    ///< bricks with mortar
    kTiles,    ///< square tiles with joints
    kCarpet,   ///< fine speckle
    kPanels,   ///< a ceiling of square boards with perforation
    kPoster,   ///< a picture with shapes and lines of text
    kBooks,    ///< backs of books
    kScreen,   ///< a dark screen with windows and text
    kOutside,  ///< a bright view out of a window
    kMetal,    ///< a painted sheet with ribs
};

/// What a surface looks like.
struct Look {
    Pattern pattern = Pattern::kPaint;
    Color base{0.8f, 0.8f, 0.8f};
};

/// Draws a picture for a surface of width x height metres. The same arguments give the same picture;
/// different seeds give different ones. Texels are 2.5 to 8 mm times texel_scale, finest where the detail is.
Texture make_texture(const Look& look, double width_m, double height_m, std::uint64_t seed,
                     double texel_scale = 1);

}  // namespace planemap::simulator
