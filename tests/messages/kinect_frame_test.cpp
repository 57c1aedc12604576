// SPDX-License-Identifier: BSD-3-Clause
#include "messages/kinect_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "messages/image_codec.hpp"
#include "messages/image_pixels.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

using bot_core::images_t;
using kinect::depth_msg_t;
using kinect::image_msg_t;
using testing::HasSubstr;

constexpr int kWidth = 8, kHeight = 6, kPixels = kWidth * kHeight;

/// Millimetres, no colour.
kinect::frame_msg_t frame_of(std::uint16_t reading) {
    kinect::frame_msg_t frame{};
    frame.timestamp = 5000000;
    frame.image.image_data_format = image_msg_t::VIDEO_NONE;
    frame.depth.timestamp = 4990000;
    frame.depth.width = kWidth;
    frame.depth.height = kHeight;
    frame.depth.depth_data_format = depth_msg_t::DEPTH_MM;
    const std::vector<std::uint16_t> pixels(kPixels, reading);
    frame.depth.depth_data.resize(2 * kPixels);
    std::memcpy(frame.depth.depth_data.data(), pixels.data(), 2 * kPixels);
    return frame;
}

DepthImage depth_of(const images_t& images) {
    return depth_pixels(*find_depth(images), depth_is_zipped(images));
}

void zip(depth_msg_t& depth) {
    DepthImage image(depth.width, depth.height);
    std::memcpy(image.pixels.data(), depth.depth_data.data(), depth.depth_data.size());
    depth.depth_data = encode_zipped_depth(image);
    depth.compression = depth_msg_t::COMPRESSION_ZLIB;
}

std::string error_for(const kinect::frame_msg_t& frame) {
    return test::error_of([&] { to_images(frame); });
}

TEST(KinectFrame, MillimetresStayAsTheyAre) {
    auto frame = frame_of(1234);
    EXPECT_EQ(depth_of(to_images(frame)).pixels, std::vector<std::uint16_t>(kPixels, 1234));
    EXPECT_EQ(to_images(frame).utime, 4990000);
    frame.depth.timestamp = 77;  // a device's ticks
    EXPECT_EQ(to_images(frame).utime, 5000000);
    zip(frame.depth);
    frame.depth.depth_data_format = depth_msg_t::DEPTH_REGISTERED;
    const images_t images = to_images(frame);
    EXPECT_TRUE(depth_is_zipped(images)) << "passed on as it came";
    EXPECT_EQ(depth_of(images).pixels, std::vector<std::uint16_t>(kPixels, 1234));
}

TEST(KinectFrame, RawReadingsBecomeMillimetres) {
    auto frame = frame_of(800);
    frame.depth.depth_data_format = depth_msg_t::DEPTH_11BIT;
    const std::uint16_t expected = kinect_millimetres(800);
    EXPECT_NEAR(expected, 1194, 1);  // the reference plane but for the offset of 0.375
    EXPECT_EQ(depth_of(to_images(frame)).pixels, std::vector<std::uint16_t>(kPixels, expected));
    zip(frame.depth);
    EXPECT_EQ(depth_of(to_images(frame)).pixels, std::vector<std::uint16_t>(kPixels, expected));
}

TEST(KinectFrame, RawReadingsGrowWithDistance) {
    std::uint16_t last = 0;
    for (std::uint16_t raw = 0; raw < 1080; ++raw) {
        const std::uint16_t mm = kinect_millimetres(raw);
        if (mm == 0) continue;
        EXPECT_GE(mm, last) << raw;
        last = mm;
    }
    EXPECT_GT(last, 7000);
    for (const std::uint16_t raw : std::vector<std::uint16_t>{1100, 2047, 2048, 65535})
        EXPECT_EQ(kinect_millimetres(raw), 0) << raw;
}

TEST(KinectFrame, ColourOfEveryForm) {
    auto frame = frame_of(1000);
    frame.image.width = kWidth;
    frame.image.height = kHeight;
    frame.image.image_data_format = image_msg_t::VIDEO_RGB;
    for (int i = 0; i < kPixels; ++i)
        frame.image.image_data.insert(frame.image.image_data.end(), {200, 100, 50});
    const images_t rgb = to_images(frame);
    EXPECT_EQ(color_pixels(*find_color(rgb))(3, 3), (Rgb{200, 100, 50}));

    frame.image.image_data_format = image_msg_t::VIDEO_BAYER;
    frame.image.image_data.clear();
    for (int v = 0; v < kHeight; ++v)
        for (int u = 0; u < kWidth; ++u)
            frame.image.image_data.push_back((u + v) % 2 == 0 ? 100 : v % 2 == 0 ? 200 : 50);
    const images_t bayer = to_images(frame);
    for (int v = 0; v < kHeight; ++v)
        for (int u = 0; u < kWidth; ++u)
            EXPECT_EQ(color_pixels(*find_color(bayer))(u, v), (Rgb{200, 100, 50})) << u << " " << v;

    frame.image.image_data_format = image_msg_t::VIDEO_RGB_JPEG;
    frame.image.image_data = encode_jpeg(RgbImage(kWidth, kHeight, {90, 90, 90}), 90);
    EXPECT_NEAR(luma_pixels(*find_color(to_images(frame)))(2, 2), 90, 2);
}

TEST(KinectFrame, WhatIsNotThereIsLeftOut) {
    auto frame = frame_of(1000);
    EXPECT_EQ(find_color(to_images(frame)), nullptr);
    frame.depth.depth_data_format = depth_msg_t::DEPTH_NONE;
    EXPECT_EQ(to_images(frame).n_images, 0);
    EXPECT_FALSE(has_depth(frame));
}

TEST(KinectFrame, HostileFieldsAreNamed) {
    auto frame = frame_of(1000);
    frame.depth.depth_data.pop_back();
    EXPECT_THAT(error_for(frame), HasSubstr("depth image of 95 bytes instead of 96"));
    frame = frame_of(1000);
    frame.depth.width = -1;
    EXPECT_THAT(error_for(frame), HasSubstr("-1x6"));
    frame.depth.width = 32767;
    EXPECT_THAT(error_for(frame), HasSubstr("32767x6"));
    frame = frame_of(1000);
    frame.depth.depth_data_format = 1;
    EXPECT_THAT(error_for(frame), HasSubstr("depth_data_format 1"));
    frame = frame_of(1000);
    frame.depth.compression = 9;
    EXPECT_THAT(error_for(frame), HasSubstr("compression 9"));
    frame = frame_of(1000);
    frame.depth.width = frame.depth.height = 4096;
    frame.depth.compression = depth_msg_t::COMPRESSION_ZLIB;
    EXPECT_THAT(error_for(frame), HasSubstr("cannot hold 4096x4096")) << "no 32 MB for 96 bytes";
    frame = frame_of(1000);
    frame.image.width = frame.image.height = 4;
    frame.image.image_data_format = image_msg_t::VIDEO_BAYER;
    EXPECT_THAT(error_for(frame), HasSubstr("colour image of 0 bytes instead of 16"));
    frame.image.image_data_format = 55;
    EXPECT_THAT(error_for(frame), HasSubstr("image_data_format 55"));
    frame = frame_of(1000);
    frame.timestamp = INT64_MIN;
    EXPECT_THAT(error_for(frame), HasSubstr("timestamp"));
}

}  // namespace
}  // namespace planemap::messages
