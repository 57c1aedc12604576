// SPDX-License-Identifier: BSD-3-Clause
#include "core/yuv.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(Yuv, WithoutColorItIsGrey) {
    for (const int y : {0, 1, 127, 255}) {
        const auto grey = static_cast<std::uint8_t>(y);
        EXPECT_EQ(rgb_of_yuv(y, 128, 128), (Rgb{grey, grey, grey}));
    }
}

TEST(Yuv, PrimariesComeBack) {
    EXPECT_EQ(rgb_of_yuv(76.245, 84.97, 255.5), (Rgb{255, 0, 0}));
    EXPECT_EQ(rgb_of_yuv(29.07, 255.5, 107.26), (Rgb{0, 0, 255}));
}

TEST(Yuv, WhatNoPixelCanShowIsTheNearest) {
    EXPECT_EQ(rgb_of_yuv(255, 128, 255).r, 255);
    EXPECT_EQ(rgb_of_yuv(0, 0, 128).b, 0);
}

}  // namespace
}  // namespace planemap
