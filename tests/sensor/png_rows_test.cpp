// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/png_rows.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <random>
#include <string>

#include "sensor/png.hpp"
#include "sensor/test_images.hpp"

namespace planemap::sensor {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth = 37, kHeight = 21;

std::string number(std::size_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift);
    return text;
}

std::string chunk(const std::string& type, const std::string& data) {
    const std::string summed = type + data;
    return number(data.size()) + summed + number(libdeflate_crc32(0, summed.data(), summed.size()));
}

std::string header(int color_type, int bit_depth, char interlaced = 0) {
    return chunk("IHDR", number(kWidth) + number(kHeight) + static_cast<char>(bit_depth) +
                             static_cast<char>(color_type) + std::string(2, '\0') + interlaced);
}

std::string deflated(const Bytes& bytes) {
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    std::string out(libdeflate_zlib_compress_bound(compressor, bytes.size()), '\0');
    out.resize(libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), out.data(), out.size()));
    libdeflate_free_compressor(compressor);
    return out;
}

const std::string kSignature = "\x89PNG\r\n\x1a\n";

/// Rows as a file has them, each behind its filter: which comes in turn, or always the same one.
Bytes filtered(const Bytes& pixels, int bytes_per_pixel, int filter = -1) {
    const std::size_t row = static_cast<std::size_t>(kWidth) * static_cast<std::size_t>(bytes_per_pixel);
    Bytes out;
    for (std::size_t y = 0; y < kHeight; ++y) {
        const int which = filter < 0 ? static_cast<int>(y % 5) : filter;
        out.push_back(static_cast<std::uint8_t>(which));
        for (std::size_t i = 0; i < row; ++i) {
            const std::size_t at = y * row + i, step = static_cast<std::size_t>(bytes_per_pixel);
            const int a = i >= step ? pixels[at - step] : 0, b = y > 0 ? pixels[at - row] : 0;
            const int c = i >= step && y > 0 ? pixels[at - row - step] : 0;
            const int p = a + b - c;  // Paeth, as the specification words it
            const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
            const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
            const int predicted[] = {0, a, b, (a + b) / 2, paeth};
            out.push_back(static_cast<std::uint8_t>(pixels[at] - predicted[which]));
        }
    }
    return out;
}

Bytes random_bytes(int bytes_per_pixel) {
    std::mt19937 random(3);
    Bytes bytes(static_cast<std::size_t>(kWidth * kHeight * bytes_per_pixel));
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
}

TEST(PngRows, EveryFilterOfEveryPixelSizeIsTakenBack) {
    const struct {
        int bit_depth, color_type, bytes;
    } formats[] = {{8, 0, 1}, {16, 0, 2}, {8, 2, 3}, {8, 6, 4}};
    for (const auto& f : formats) {
        const Bytes pixels = random_bytes(f.bytes);
        for (int filter = -1; filter < 5; ++filter) {
            const std::string png = kSignature + header(f.color_type, f.bit_depth) +
                                    chunk("IDAT", deflated(filtered(pixels, f.bytes, filter))) +
                                    chunk("IEND", "");
            Bytes rows(pixels.size());
            ASSERT_TRUE(decode_png_rows(png, {kWidth, kHeight, f.bit_depth, f.color_type, f.bytes}, rows));
            EXPECT_EQ(rows, pixels) << f.bytes << " bytes, filter " << filter;
        }
    }
}

TEST(PngRows, WhatIsNotTheUsualIsLeftToOthers) {
    const Bytes pixels = random_bytes(3);
    const PngFormat rgb{kWidth, kHeight, 8, 2, 3};
    const std::string data = chunk("IDAT", deflated(filtered(pixels, 3))), end = chunk("IEND", "");
    const std::string start = kSignature + header(2, 8);
    Bytes rows(pixels.size());
    const auto takes = [&](const std::string& png) { return decode_png_rows(png, rgb, rows); };
    EXPECT_TRUE(takes(start + data + end));
    EXPECT_TRUE(takes(start + chunk("tEXt", "Comment") + data + chunk("tIME", "1234567") + end));
    EXPECT_FALSE(takes("")) << "nothing";
    EXPECT_FALSE(takes(kSignature)) << "no header";
    EXPECT_FALSE(takes(start + end)) << "no pixels";
    EXPECT_FALSE(takes(start + data)) << "no end";
    EXPECT_FALSE(takes(kSignature + header(2, 8, 1) + data + end)) << "interlaced";
    EXPECT_FALSE(takes(kSignature + header(6, 8) + data + end)) << "another type";
    EXPECT_FALSE(takes(start + chunk("PLTE", "123") + data + end)) << "a palette";
    EXPECT_FALSE(takes(start + data + chunk("tEXt", "x") + data + end)) << "pixels in two places";
    Bytes longer = filtered(pixels, 3), shorter = longer, unknown = longer;
    longer.push_back(0);
    shorter.pop_back();
    unknown[0] = 5;
    EXPECT_FALSE(takes(start + chunk("IDAT", deflated(longer)) + end));
    EXPECT_FALSE(takes(start + chunk("IDAT", deflated(shorter)) + end));
    EXPECT_FALSE(takes(start + chunk("IDAT", deflated(unknown)) + end)) << "no such filter";
    EXPECT_THROW(decode_png_rows(start + data + end, rgb, std::span(rows).first(5)), std::invalid_argument);
}

TEST(PngRows, PixelsMayComeInManyChunks) {
    const Bytes pixels = random_bytes(3);
    const std::string stream = deflated(filtered(pixels, 3));
    std::string png = kSignature + header(2, 8);
    for (std::size_t at = 0; at < stream.size(); at += 100) png += chunk("IDAT", stream.substr(at, 100));
    Bytes rows(pixels.size());
    ASSERT_TRUE(decode_png_rows(png + chunk("IEND", ""), {kWidth, kHeight, 8, 2, 3}, rows));
    EXPECT_EQ(rows, pixels);
}

TEST(PngRows, AChangedByteIsNotTaken) {
    const Bytes pixels = random_bytes(2);
    const std::string png =
        kSignature + header(0, 16) + chunk("IDAT", deflated(filtered(pixels, 2))) + chunk("IEND", "");
    Bytes rows(pixels.size());
    for (std::size_t i = 8; i < png.size(); ++i) {
        std::string damaged = png;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x24);
        EXPECT_FALSE(decode_png_rows(damaged, {kWidth, kHeight, 16, 0, 2}, rows)) << i;
    }
}

/// As spng reads the same file, whose filters are libpng's choice.
TEST(PngRows, GivesWhatSpngGives) {
    DepthImage depth(kWidth, kHeight);
    RgbImage color(kWidth, kHeight);
    for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
            depth(u, v) = static_cast<std::uint16_t>(5000 + 13 * u * v);
            color(u, v) = {static_cast<std::uint8_t>(5 * u), static_cast<std::uint8_t>(7 * v), 90};
        }
    }
    EXPECT_EQ(decode_depth_png(encode_depth_png(depth), kWidth, kHeight).pixels, depth.pixels);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(color.pixels.data());
    const std::string png =
        encode_png(kWidth, kHeight, SPNG_COLOR_TYPE_TRUECOLOR, 8, {bytes, bytes + 3 * color.pixels.size()});
    Bytes rows(3 * color.pixels.size());
    EXPECT_TRUE(decode_png_rows(png, {kWidth, kHeight, 8, 2, 3}, rows));
    EXPECT_EQ(decode_color_png(png, kWidth, kHeight).pixels, color.pixels);
}

}  // namespace
}  // namespace planemap::sensor
