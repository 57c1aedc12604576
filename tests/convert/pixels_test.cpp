// SPDX-License-Identifier: BSD-3-Clause
#include "convert/pixels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "temporary_folder.hpp"

namespace planemap::convert {
namespace {

using testing::HasSubstr;

const PinholeCamera kCamera{4, 2, 5, 5, 2, 1};

std::vector<std::uint8_t> bytes_of(const auto& values) {
    std::vector<std::uint8_t> bytes(values.size() * sizeof(values[0]));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

TEST(Pixels, DepthOfEveryEncoding) {
    const std::vector<std::uint16_t> mm = {1, 2, 3, 4, 5, 6, 7, 65535};
    auto bytes = bytes_of(mm);
    for (const char* encoding : {"16UC1", "mono16"})
        EXPECT_EQ(depth_of({4, 2, 8, false, encoding, bytes}, kCamera).pixels, mm);
    for (std::size_t i = 0; i < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
    EXPECT_EQ(depth_of({4, 2, 8, true, "16UC1", bytes}, kCamera).pixels, mm);
    const std::vector<float> metres = {1.f, 2.5f, std::nanf(""), INFINITY, -1.f, 0.f, 13.f, 20.f};
    EXPECT_EQ(depth_of({4, 2, 16, false, "32FC1", bytes_of(metres)}, kCamera).pixels,
              (std::vector<std::uint16_t>{5000, 12500, 0, 0, 0, 0, 65000, 0}));
}

TEST(Pixels, ColoursOfEveryEncoding) {
    const auto pixel = [](const char* encoding, std::vector<std::uint8_t> one) {
        std::vector<std::uint8_t> all;
        for (int i = 0; i < 8; ++i) all.insert(all.end(), one.begin(), one.end());
        return color_of({4, 2, 4 * one.size(), false, encoding, all}, kCamera)(3, 1);
    };
    EXPECT_EQ(pixel("rgb8", {1, 2, 3}), (Rgb{1, 2, 3}));
    EXPECT_EQ(pixel("bgr8", {1, 2, 3}), (Rgb{3, 2, 1}));
    EXPECT_EQ(pixel("rgba8", {1, 2, 3, 4}), (Rgb{1, 2, 3}));
    EXPECT_EQ(pixel("bgra8", {1, 2, 3, 4}), (Rgb{3, 2, 1}));
    EXPECT_EQ(pixel("mono8", {9}), (Rgb{9, 9, 9}));
    EXPECT_EQ(pixel("yuv422", {128, 77}), (Rgb{77, 77, 77}));
    EXPECT_EQ(pixel("yuyv", {77, 128}), (Rgb{77, 77, 77}));
    const std::vector<std::uint8_t> rggb = {200, 100, 200, 100, 100, 50, 100, 50};
    EXPECT_EQ(color_of({4, 2, 4, false, "bayer_rggb8", rggb}, kCamera)(1, 1), (Rgb{200, 100, 50}));
    EXPECT_EQ(color_of({4, 2, 4, false, "bayer_bggr8", rggb}, kCamera)(1, 1), (Rgb{50, 100, 200}));
}

TEST(Pixels, HostileImagesAreRefused) {
    const std::vector<std::uint8_t> few(10);
    const auto error = [&](int width, int height, std::size_t step, const char* encoding) {
        return test::error_of([&] { color_of({width, height, step, false, encoding, few}, kCamera); });
    };
    EXPECT_THAT(error(4, 2, 12, "rgb8"), HasSubstr("10 bytes in rows of 12 do not hold 4x2 pixels of rgb8"));
    EXPECT_THAT(error(4, 2, 1, "mono8"), HasSubstr("do not hold"));
    EXPECT_THAT(error(4, 2, SIZE_MAX, "mono8"), HasSubstr("do not hold"));
    EXPECT_THAT(error(100000, 100000, 100000, "mono8"), HasSubstr("its camera 4x2"));
    EXPECT_THAT(error(4, 2, 4, "64FC4"), HasSubstr("64FC4"));
    EXPECT_THAT(test::error_of([&] { depth_of_compressed("16UC1", few, kCamera); }), HasSubstr("10 bytes"));
}

}  // namespace
}  // namespace planemap::convert
