// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/files.hpp"
#include "sensor/test_images.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

using testing::HasSubstr;

TEST(Png, DepthComesBackExactly) {
    const DepthImage depth = numbered_depth(37, 21);
    EXPECT_EQ(decode_depth_png(encode_depth_png(depth), 37, 21).pixels, depth.pixels);
    const test::TemporaryFolder folder;
    write_depth_png(folder.path() / "a.png", depth);
    EXPECT_EQ(decode_depth_png(read_file(folder.path() / "a.png"), 37, 21).pixels, depth.pixels);
}

TEST(Png, ColorComesBackExactly) {
    RgbImage color(5, 3);
    for (std::size_t i = 0; i < color.pixels.size(); ++i) {
        const auto value = static_cast<std::uint8_t>(i);
        color.pixels[i] = {value, static_cast<std::uint8_t>(value + 50),
                           static_cast<std::uint8_t>(value + 100)};
    }
    const test::TemporaryFolder folder;
    write_color_png(folder.path() / "a.png", color);
    EXPECT_EQ(decode_color_png(read_file(folder.path() / "a.png"), 5, 3).pixels, color.pixels);
}

TEST(Png, EveryEightBitColorTypeIsConverted) {
    const Rgb dark{10, 10, 10}, red{200, 30, 40};
    const auto grey = decode_color_png(encode_png(2, 1, SPNG_COLOR_TYPE_GRAYSCALE, 8, {10, 99}), 2, 1);
    EXPECT_EQ(grey(0, 0), dark);
    const auto rgba =
        decode_color_png(encode_png(1, 1, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 8, {200, 30, 40, 128}), 1, 1);
    EXPECT_EQ(rgba(0, 0), red);
    spng_plte palette{};
    palette.n_entries = 2;
    palette.entries[1] = {200, 30, 40, 255};
    const auto indexed =
        decode_color_png(encode_png(2, 1, SPNG_COLOR_TYPE_INDEXED, 8, {0, 1}, &palette), 2, 1);
    EXPECT_EQ(indexed(1, 0), red);
}

TEST(Png, WrongTypesAndSizesAreNamed) {
    const std::string depth = encode_depth_png(numbered_depth(8, 6));
    EXPECT_THAT(test::error_of([&] { decode_depth_png(depth, 8, 7); }), HasSubstr("8x6"));
    const std::string byte = encode_png(8, 6, SPNG_COLOR_TYPE_GRAYSCALE, 8, std::vector<std::uint8_t>(48));
    EXPECT_THAT(test::error_of([&] { decode_depth_png(byte, 8, 6); }), HasSubstr("8-bit greyscale"));
    const std::string rgb = encode_png(8, 6, SPNG_COLOR_TYPE_TRUECOLOR, 8, std::vector<std::uint8_t>(144));
    EXPECT_THAT(test::error_of([&] { decode_depth_png(rgb, 8, 6); }), HasSubstr("RGB"));
    EXPECT_THAT(test::error_of([&] { decode_color_png(depth, 8, 6); }), HasSubstr("has 16"));
    EXPECT_THAT(test::error_of([&] { decode_depth_png("", 8, 6); }), HasSubstr("not a PNG"));
    EXPECT_THAT(test::error_of([&] { decode_depth_png("JFIF and so on", 8, 6); }), HasSubstr("not a PNG"));
}

TEST(Png, AHugeSizeInTheHeaderAllocatesNothing) {
    std::string png = encode_depth_png(numbered_depth(8, 6));
    for (std::size_t i = 16; i < 24; ++i) png[i] = '\x7f';  // width and height, the checksum left as it was
    EXPECT_NE(test::error_of([&] { decode_depth_png(png, 0x7f7f7f7f, 0x7f7f7f7f); }), "");
}

TEST(Png, EveryTruncationIsAnError) {
    const std::string png = encode_depth_png(numbered_depth(16, 12));
    constexpr std::size_t kChecksum = 4;  // the end marker's may be missing
    for (std::size_t size = 0; size < png.size() - kChecksum; ++size) {
        EXPECT_NE(test::error_of([&] { decode_depth_png(std::string_view(png).substr(0, size), 16, 12); }),
                  "")
            << size;
    }
}

TEST(Png, AnEndBehindAllPixelsMayBeMissing) {
    const DepthImage depth = numbered_depth(16, 12);
    const std::string png = encode_depth_png(depth);
    std::size_t mended = 0;
    for (std::size_t size = 0; size <= png.size(); ++size) {
        bool end_missing = false;
        try {
            const auto bytes = std::string_view(png).substr(0, size);
            EXPECT_EQ(decode_depth_png(bytes, 16, 12, &end_missing).pixels, depth.pixels) << size;
            mended += end_missing ? 1 : 0;
        } catch (const std::runtime_error&) {
            EXPECT_LT(size, png.size() - 12) << "all but the end marker was there";
        }
    }
    EXPECT_GE(mended, 8u) << "an end marker of 12 bytes, whose checksum may always be missing";
    bool end_missing = true;
    decode_depth_png(png, 16, 12, &end_missing);
    EXPECT_FALSE(end_missing);
}

TEST(Png, AChangedByteIsAnErrorWithAMissingEndToo) {
    const DepthImage depth = numbered_depth(16, 12);
    const std::string png = encode_depth_png(depth);
    for (std::size_t i = 0; i < png.size() - 12; ++i) {
        std::string damaged = png.substr(0, png.size() - 12);
        damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
        bool end_missing = false;
        try {
            EXPECT_EQ(decode_depth_png(damaged, 16, 12, &end_missing).pixels, depth.pixels) << i;
        } catch (const std::runtime_error&) {
        }
    }
}

TEST(Png, AChangedByteIsAnErrorOrChangesNothing) {
    const DepthImage depth = numbered_depth(16, 12);
    const std::string png = encode_depth_png(depth);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < png.size(); ++i) {
        std::string damaged = png;
        damaged[i] = static_cast<char>(damaged[i] ^ static_cast<char>(1 + random() % 255));
        try {
            EXPECT_EQ(decode_depth_png(damaged, 16, 12).pixels, depth.pixels) << i;
        } catch (const std::runtime_error&) {
        }
    }
}

}  // namespace
}  // namespace planemap::sensor
