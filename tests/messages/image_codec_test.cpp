// SPDX-License-Identifier: BSD-3-Clause
#include "messages/image_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace planemap::messages {
namespace {

RgbImage gradient(int width, int height) {
    RgbImage image(width, height);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            image(u, v) = {static_cast<std::uint8_t>(255 * u / width),
                           static_cast<std::uint8_t>(255 * v / height), 90};
        }
    }
    return image;
}

DepthImage random_depth(int width, int height) {
    std::mt19937_64 random(3);
    DepthImage depth(width, height);
    for (auto& z : depth.pixels) z = static_cast<std::uint16_t>(random());
    return depth;
}

TEST(ImageCodec, JpegComesBackNearly) {
    const RgbImage image = gradient(70, 50);
    const auto jpeg = encode_jpeg(image, 95);
    const GrayImage gray = decode_jpeg_luma(jpeg, 70, 50), expected = luma(image);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_LT(std::abs(gray.pixels[i] - expected.pixels[i]), 6);
}

TEST(ImageCodec, JpegOfTheWrongSizeCutShortOrGarbageIsAnError) {
    const auto jpeg = encode_jpeg(gradient(70, 50), 90);
    EXPECT_THROW(decode_jpeg_luma(jpeg, 71, 50), MessageError);
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{1}, std::size_t{20}, jpeg.size() / 2, jpeg.size() - 20}) {
        EXPECT_THROW(decode_jpeg_luma(std::span(jpeg).first(length), 70, 50), MessageError) << length;
    }
    std::vector<std::uint8_t> garbage(1000, 0x5a);
    EXPECT_THROW(decode_jpeg_luma(garbage, 70, 50), MessageError);
}

TEST(ImageCodec, AfterACorruptJpegTheNextOneIsRead) {
    const auto jpeg = encode_jpeg(gradient(70, 50), 90);
    EXPECT_THROW(decode_jpeg_luma(std::span(jpeg).first(jpeg.size() / 2), 70, 50), MessageError);
    EXPECT_NO_THROW(decode_jpeg_luma(jpeg, 70, 50));
}

TEST(ImageCodec, ZippedDepthComesBackExactly) {
    const DepthImage depth = random_depth(31, 17);
    const auto zipped = encode_zipped_depth(depth);
    EXPECT_EQ(decode_zipped_depth(zipped, 31, 17).pixels, depth.pixels);
}

TEST(ImageCodec, ZippedDepthMustFillTheImageExactly) {
    const auto zipped = encode_zipped_depth(random_depth(31, 17));
    EXPECT_THROW(decode_zipped_depth(zipped, 31, 18), MessageError);
    EXPECT_THROW(decode_zipped_depth(zipped, 31, 16), MessageError);
    EXPECT_THROW(decode_zipped_depth(std::span(zipped).first(zipped.size() / 2), 31, 17), MessageError);
    EXPECT_THROW(decode_zipped_depth({}, 31, 17), MessageError);
}

}  // namespace
}  // namespace planemap::messages
