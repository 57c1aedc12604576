// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace planemap::simulator {
namespace {

constexpr Pattern kAll[] = {Pattern::kPaint, Pattern::kWood,   Pattern::kPlanks,  Pattern::kBrick,
                            Pattern::kTiles, Pattern::kCarpet, Pattern::kPanels,  Pattern::kPoster,
                            Pattern::kBooks, Pattern::kScreen, Pattern::kOutside, Pattern::kMetal};

/// Standard deviation of green over the picture.
double contrast(const Texture& texture) {
    double sum = 0, squares = 0;
    for (const std::uint32_t texel : texture.levels.front().pixels) {
        const double green = texel >> 8 & 255;
        sum += green;
        squares += green * green;
    }
    const auto count = static_cast<double>(texture.levels.front().pixels.size());
    return std::sqrt(squares / count - sum * sum / count / count);
}

TEST(Texture, EachLevelIsHalfTheOneBefore) {
    for (const Pattern pattern : kAll) {
        const Texture texture = make_texture({pattern, {0.6f, 0.6f, 0.6f}}, 0.7, 0.4, 1);
        ASSERT_GE(texture.levels.size(), 2u);
        for (std::size_t i = 1; i < texture.levels.size(); ++i) {
            EXPECT_EQ(2 * texture.levels[i].width, texture.levels[i - 1].width);
            EXPECT_EQ(2 * texture.levels[i].height, texture.levels[i - 1].height);
        }
    }
}

TEST(Texture, TinyAndHugeSurfacesHaveABoundedPicture) {
    const Texture tiny = make_texture({}, 1e-6, 1e-6, 1);
    EXPECT_GE(tiny.levels.back().width, 2);
    EXPECT_GE(tiny.levels.back().height, 2);
    EXPECT_LE(make_texture({}, 1000, 0.1, 1).levels.front().width, 4096);
}

TEST(Texture, SeedsDifferAndRepeat) {
    for (const Pattern pattern : kAll) {
        const Look look{pattern, {0.6f, 0.6f, 0.6f}};
        const auto first = make_texture(look, 0.5, 0.5, 1).levels.front().pixels;
        EXPECT_EQ(first, make_texture(look, 0.5, 0.5, 1).levels.front().pixels);
        if (pattern != Pattern::kMetal) {
            EXPECT_NE(first, make_texture(look, 0.5, 0.5, 2).levels.front().pixels);
        }
    }
}

TEST(Texture, PaintIsBareAndPostersAreNot) {
    const double paint = contrast(make_texture({Pattern::kPaint, {0.8f, 0.8f, 0.8f}}, 2, 2, 3));
    EXPECT_GT(paint, 0.5);
    EXPECT_LT(paint, 8);
    EXPECT_GT(contrast(make_texture({Pattern::kPoster, {0.9f, 0.9f, 0.9f}}, 0.6, 0.8, 3)), 30);
}

}  // namespace
}  // namespace planemap::simulator
