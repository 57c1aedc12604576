// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/texture.hpp"

#include <algorithm>
#include <cmath>

#include "core/rounding.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

namespace {

/// In [0, 1], for each lattice point another value.
float hash01(int x, int y, std::uint64_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
                      static_cast<std::uint32_t>(y) * 0x85ebca77u ^ static_cast<std::uint32_t>(seed) ^
                      static_cast<std::uint32_t>(seed >> 32);
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    h ^= h >> 15;
    return static_cast<float>(h >> 8) * 0x1p-24f;
}

/// Smooth noise in [-1, 1] with features one unit apart.
float value_noise(float x, float y, std::uint64_t seed) {
    const float fx = std::floor(x), fy = std::floor(y);
    const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
    const float u = x - fx, v = y - fy;
    const float su = u * u * (3 - 2 * u), sv = v * v * (3 - 2 * v);
    const float top = std::lerp(hash01(ix, iy, seed), hash01(ix + 1, iy, seed), su);
    const float bottom = std::lerp(hash01(ix, iy + 1, seed), hash01(ix + 1, iy + 1, seed), su);
    return 2 * std::lerp(top, bottom, sv) - 1;
}

/// Noise over several octaves; `size_m` is the size of the largest features.
float octaves(float x, float y, float size_m, int count, std::uint64_t seed) {
    float sum = 0, amplitude = 1, scale = 1 / size_m;
    for (int i = 0; i < count; ++i, amplitude *= 0.55f, scale *= 2.1f) {
        sum += amplitude * value_noise(x * scale, y * scale, seed + static_cast<std::uint64_t>(i));
    }
    return sum;
}

/// 1 inside a joint of the given width around multiples of `period`, falling to 0 over one joint's width.
float joint(float x, float period, float width) {
    const float distance = std::fabs(x - period * std::round(x / period));
    return std::clamp(1.5f - distance / width, 0.0f, 1.0f);
}

Color paint(Color base, float x, float y, std::uint64_t seed) {
    const float faint = 0.02f * octaves(x, y, 0.6f, 2, seed) + 0.012f * value_noise(x * 90, y * 90, seed + 7);
    const float mark = value_noise(x * 2.3f, y * 2.3f, seed + 9) * value_noise(x * 31, y * 31, seed + 11);
    return (1 + faint - (mark > 0.55f ? 0.35f * (mark - 0.55f) : 0.0f)) * base;
}

Color wood(Color base, float x, float y, std::uint64_t seed) {
    const float bend = 0.03f * octaves(x * 0.5f, y * 2, 0.3f, 2, seed);
    const float ring = std::sin(60 * (y + bend) + 3 * value_noise(x * 2, y * 9, seed + 3));
    const float grain = value_noise(x * 12, y * 210, seed + 5);
    return (1 + 0.09f * ring + 0.10f * grain) * base;
}

Color planks(Color base, float x, float y, std::uint64_t seed) {
    constexpr float kWidth = 0.14f, kLength = 1.1f;
    const int row = static_cast<int>(std::floor(y / kWidth));
    const float shifted = x + kLength * hash01(row, 1, seed);
    const int plank = static_cast<int>(std::floor(shifted / kLength));
    const float tone = 0.78f + 0.4f * hash01(row, plank + 100, seed);
    const float gap = std::max(joint(y, kWidth, 0.004f), joint(shifted, kLength, 0.004f));
    const Color plain = tone * wood(base, x, y, seed + static_cast<std::uint64_t>(row * 131 + plank + 5000));
    return blend(plain, 0.25f * base, 0.8f * gap);
}

Color brick(Color base, float x, float y, std::uint64_t seed) {
    constexpr float kWidth = 0.25f, kHeight = 0.08f;
    const int row = static_cast<int>(std::floor(y / kHeight));
    const float shifted = x + ((row & 1) != 0 ? 0.5f * kWidth : 0.0f);
    const int column = static_cast<int>(std::floor(shifted / kWidth));
    const float tone = 0.7f + 0.5f * hash01(column, row, seed) + 0.12f * octaves(x, y, 0.03f, 2, seed);
    const float mortar = std::max(joint(y, kHeight, 0.008f), joint(shifted, kWidth, 0.008f));
    return blend(tone * base, {0.72f, 0.70f, 0.66f}, 0.9f * mortar);
}

Color tiles(Color base, float x, float y, std::uint64_t seed) {
    constexpr float kSize = 0.3f;
    const int column = static_cast<int>(std::floor(x / kSize)), row = static_cast<int>(std::floor(y / kSize));
    const float tone = 0.85f + 0.2f * hash01(column, row, seed) + 0.06f * octaves(x, y, 0.06f, 2, seed);
    const float gap = std::max(joint(x, kSize, 0.005f), joint(y, kSize, 0.005f));
    return blend(tone * base, 0.5f * base, gap);
}

Color carpet(Color base, float x, float y, std::uint64_t seed) {
    const float fleck = value_noise(x * 70, y * 70, seed);
    return (1 + 0.25f * fleck + 0.08f * octaves(x, y, 0.25f, 2, seed + 3)) * base;
}

Color panels(Color base, float x, float y, std::uint64_t seed) {
    constexpr float kSize = 0.6f;
    const float gap = std::max(joint(x, kSize, 0.006f), joint(y, kSize, 0.006f));
    const float speck = value_noise(x * 45, y * 45, seed);
    const float plain = 1 + 0.02f * octaves(x, y, 0.4f, 2, seed + 1) - (speck > 0.72f ? 0.16f : 0.0f);
    return blend(plain * base, 0.55f * base, 0.8f * gap);
}

Color metal(Color base, float x, float y, std::uint64_t seed) {
    const float rib = joint(x, 0.06f, 0.008f);
    return (1 + 0.02f * octaves(x, y, 0.3f, 2, seed) - 0.22f * rib) * base;
}

Color books(Color, float x, float y, std::uint64_t seed) {
    constexpr float kWidth = 0.035f;
    const float bent = x + 0.012f * value_noise(x * 7, 0.5f, seed);
    const int book = static_cast<int>(std::floor(bent / kWidth));
    const Color cover{0.15f + 0.7f * hash01(book, 1, seed), 0.15f + 0.6f * hash01(book, 2, seed),
                      0.15f + 0.55f * hash01(book, 3, seed)};
    const float band = std::fabs(y - 0.04f - 0.15f * hash01(book, 4, seed)) < 0.02f ? 1.0f : 0.0f;
    const float gap = joint(bent, kWidth, 0.003f);
    return blend(blend(cover, {0.9f, 0.87f, 0.75f}, 0.7f * band), {0.05f, 0.05f, 0.05f}, 0.8f * gap);
}

Color outside(Color, float x, float y, std::uint64_t seed) {
    const float skyline =
        0.62f + 0.12f * value_noise(x * 3, 0.5f, seed) + 0.04f * value_noise(x * 19, 0.5f, seed);
    const float frame = std::max(joint(x, 0.7f, 0.03f), joint(y, 1.4f, 0.03f));
    const float leaf = octaves(x, y, 0.08f, 3, seed + 4);
    const Color sky = (1 + 0.02f * octaves(x, y, 0.3f, 2, seed + 8)) * Color{0.93f, 0.95f, 0.98f};
    const Color trees = (1 + 0.25f * leaf) * Color{0.42f, 0.52f, 0.38f};
    return blend(y < skyline ? sky : trees, {0.85f, 0.85f, 0.84f}, frame);
}

Color pattern(const Look& look, float x, float y, std::uint64_t seed) {
    switch (look.pattern) {
        case Pattern::kWood:
            return wood(look.base, x, y, seed);
        case Pattern::kPlanks:
            return planks(look.base, x, y, seed);
        case Pattern::kBrick:
            return brick(look.base, x, y, seed);
        case Pattern::kTiles:
            return tiles(look.base, x, y, seed);
        case Pattern::kCarpet:
            return carpet(look.base, x, y, seed);
        case Pattern::kPanels:
            return panels(look.base, x, y, seed);
        case Pattern::kMetal:
            return metal(look.base, x, y, seed);
        case Pattern::kBooks:
            return books(look.base, x, y, seed);
        case Pattern::kOutside:
            return outside(look.base, x, y, seed);
        case Pattern::kPaint:
        case Pattern::kPoster:
        case Pattern::kScreen:
            return paint(look.base, x, y, seed);
    }
    return look.base;
}

std::uint32_t texel(Color c) {
    const auto byte = [](float value) {
        return static_cast<std::uint32_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
    };
    return byte(c.r) | byte(c.g) << 8 | byte(c.b) << 16;
}

/// A sequence of random numbers for drawing.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : seed_(seed) {}
    float roll(float low, float high) { return static_cast<float>(uniform(mix(seed_, count_++), low, high)); }
    Color color() { return {roll(0.05f, 0.95f), roll(0.05f, 0.9f), roll(0.05f, 0.9f)}; }

  private:
    std::uint64_t seed_, count_ = 0;
};

/// Fills the part of an image given in shares of its width and height.
void fill_box(Image<std::uint32_t>& image, float left, float top, float right, float bottom, Color color) {
    const auto pixel = [](float share, int size) {
        return std::clamp(static_cast<int>(std::lround(share * static_cast<float>(size))), 0, size);
    };
    const int u0 = pixel(left, image.width), u1 = pixel(right, image.width);
    for (int v = pixel(top, image.height); v < pixel(bottom, image.height); ++v) {
        for (int u = u0; u < u1; ++u) image(u, v) = texel(color);
    }
}

void fill_disc(Image<std::uint32_t>& image, float x, float y, float radius, Color color) {
    const float size = static_cast<float>(std::min(image.width, image.height));
    for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
            const float du = static_cast<float>(u) - x * static_cast<float>(image.width);
            const float dv = static_cast<float>(v) - y * static_cast<float>(image.height);
            if (std::hypot(du, dv) < radius * size) image(u, v) = texel(color);
        }
    }
}

/// Lines of words of unequal length, as boxes a letter wide.
void draw_text(Image<std::uint32_t>& image, float left, float top, float right, float bottom, float line,
               Color color, Dice& dice) {
    for (float y = top; y + line < bottom; y += 1.7f * line) {
        const float end = dice.roll(left + 0.6f * (right - left), right);
        for (float x = left; x < end;) {
            const float width = line * dice.roll(0.3f, 0.8f);
            fill_box(image, x, y, std::min(x + width, end), y + line * dice.roll(0.6f, 1.0f), color);
            x += width + line * (dice.roll(0, 1) < 0.2f ? 0.9f : 0.25f);
        }
    }
}

void draw_poster(Image<std::uint32_t>& image, Color base, Dice& dice) {
    const Color ink = (dice.roll(0, 1) < 0.7f ? 0.15f : 0.4f) * dice.color();
    fill_box(image, 0, 0, 1, 1, {0.1f, 0.1f, 0.1f});
    fill_box(image, 0.015f, 0.015f, 0.985f, 0.985f, base);
    fill_box(image, 0.06f, 0.05f, 0.94f, 0.62f, dice.color());
    for (int i = 0; i < 9; ++i) {
        const float x = dice.roll(0.06f, 0.75f), y = dice.roll(0.05f, 0.5f);
        fill_box(image, x, y, std::min(x + dice.roll(0.05f, 0.3f), 0.94f),
                 std::min(y + dice.roll(0.03f, 0.25f), 0.62f), dice.color());
    }
    for (int i = 0; i < 4; ++i) {
        fill_disc(image, dice.roll(0.2f, 0.8f), dice.roll(0.15f, 0.5f), dice.roll(0.03f, 0.1f), dice.color());
    }
    draw_text(image, 0.07f, 0.66f, 0.93f, 0.74f, 0.045f, ink, dice);
    draw_text(image, 0.07f, 0.76f, 0.93f, 0.97f, 0.02f, ink, dice);
}

void draw_screen(Image<std::uint32_t>& image, Dice& dice) {
    fill_box(image, 0, 0, 1, 1, {0.08f, 0.08f, 0.09f});
    fill_box(image, 0.03f, 0.04f, 0.97f, 0.94f, {0.16f, 0.25f, 0.36f});
    for (int i = 0; i < 3; ++i) {
        const float x = dice.roll(0.05f, 0.5f), y = dice.roll(0.07f, 0.4f);
        const float right = x + dice.roll(0.3f, 0.45f), bottom = y + dice.roll(0.3f, 0.5f);
        fill_box(image, x, y, right, bottom, {0.9f, 0.9f, 0.88f});
        fill_box(image, x, y, right, y + 0.04f, dice.color());
        draw_text(image, x + 0.02f, y + 0.07f, right - 0.02f, bottom, 0.022f, {0.2f, 0.2f, 0.2f}, dice);
    }
}

/// Half the size, by averaging 2x2 texels.
Image<std::uint32_t> halved(const Image<std::uint32_t>& image) {
    Image<std::uint32_t> half(image.width / 2, image.height / 2);
    for (int v = 0; v < half.height; ++v) {
        const std::uint32_t *a = image.row(2 * v), *b = image.row(2 * v + 1);
        for (int u = 0; u < half.width; ++u, a += 2, b += 2) {
            std::uint32_t result = 0;
            for (int shift = 0; shift < 24; shift += 8) {
                const auto channel = [shift](std::uint32_t t) { return t >> shift & 255u; };
                const std::uint32_t sum = channel(a[0]) + channel(a[1]) + channel(b[0]) + channel(b[1]);
                result |= (sum + 2) / 4 << shift;
            }
            half(u, v) = result;
        }
    }
    return half;
}

/// Size of a texel in metres: fine where the detail is.
double texel_size(Pattern pattern) {
    switch (pattern) {
        case Pattern::kPaint:
        case Pattern::kMetal:
            return 0.008;
        case Pattern::kPoster:
        case Pattern::kScreen:
        case Pattern::kBooks:
            return 0.0025;
        default:
            return 0.005;
    }
}

}  // namespace

Texture make_texture(const Look& look, double width_m, double height_m, std::uint64_t seed,
                     double texel_scale) {
    // Sizes are multiples of a power of two, so that each level is exactly half of the one before and
    // the last still has two texels each way.
    constexpr int kLevels = 6, kMultiple = 1 << (kLevels - 1), kMaxSide = 4096;
    const auto texels = [&](double metres) {
        const double wanted = metres / (texel_scale * texel_size(look.pattern));
        return std::max(2, nearest_whole<int>(std::min<double>(wanted, kMaxSide) / kMultiple)) * kMultiple;
    };
    Image<std::uint32_t> image(texels(width_m), texels(height_m));
    const auto step_x = static_cast<float>(width_m / image.width);
    const auto step_y = static_cast<float>(height_m / image.height);
    Dice dice(mix(seed, 1));
    if (look.pattern == Pattern::kPoster) {
        draw_poster(image, look.base, dice);
    } else if (look.pattern == Pattern::kScreen) {
        draw_screen(image, dice);
    } else {
        for (int v = 0; v < image.height; ++v) {
            for (int u = 0; u < image.width; ++u) {
                const float x = (static_cast<float>(u) + 0.5f) * step_x;
                const float y = (static_cast<float>(v) + 0.5f) * step_y;
                image(u, v) = texel(pattern(look, x, y, seed));
            }
        }
    }
    Texture texture;
    texture.levels.push_back(std::move(image));
    while (texture.levels.size() < kLevels) texture.levels.push_back(halved(texture.levels.back()));
    return texture;
}

}  // namespace planemap::simulator
