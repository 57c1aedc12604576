// SPDX-License-Identifier: BSD-3-Clause
#include "messages/image_pixels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messages/convert.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

using bot_core::image_t;
using testing::HasSubstr;

/// A slope with a hole, in millimetres.
DepthImage slope() {
    DepthImage depth(32, 24);
    for (int v = 0; v < 24; ++v)
        for (int u = 0; u < 32; ++u)
            depth(u, v) = static_cast<std::uint16_t>(u < 4 ? 0 : 2800 + 7 * u + 3 * v);
    return depth;
}

image_t swapped(image_t image) {
    for (std::size_t i = 0; i + 1 < image.data.size(); i += 2) std::swap(image.data[i], image.data[i + 1]);
    return image;
}

TEST(ImagePixels, BigEndianDepthIsReadAsItsBytesAre) {
    for (const DepthImage& depth : {slope(), DepthImage(32, 24, 3000), DepthImage(32, 24)}) {
        image_t image = depth_image_message(depth, 1, DepthEncoding::kRaw);
        EXPECT_EQ(depth_pixels(image, false).pixels, depth.pixels);
        image.pixelformat = kBigEndianGray16;  // as common converters write it
        EXPECT_EQ(depth_pixels(image, false).pixels, depth.pixels);
        EXPECT_EQ(depth_pixels(swapped(image), false).pixels, depth.pixels) << "truly big-endian";
    }
}

TEST(ImagePixels, LittleEndianDepthIsNeverExchanged) {
    const image_t image = swapped(depth_image_message(slope(), 1, DepthEncoding::kRaw));
    EXPECT_NE(depth_pixels(image, false).pixels, slope().pixels);
}

TEST(ImagePixels, ColoursOfEveryFormat) {
    const RgbImage colors(4, 3, {10, 20, 30});
    image_t image = color_image_message(colors, 1, ColorEncoding::kRaw, 90);
    EXPECT_EQ(color_pixels(image).pixels, colors.pixels);
    image.pixelformat = image_t::PIXEL_FORMAT_BGR;
    EXPECT_EQ(color_pixels(image)(1, 1), (Rgb{30, 20, 10}));
    image.pixelformat = image_t::PIXEL_FORMAT_GRAY;
    image.row_stride = 4;
    image.data.assign(12, 77);
    EXPECT_EQ(color_pixels(image)(3, 2), (Rgb{77, 77, 77}));
    EXPECT_EQ(luma_pixels(image)(3, 2), 77);
}

TEST(ImagePixels, SizesThatTheBytesDoNotHoldAreRefusedBeforeAnyMemoryIsTaken) {
    image_t image = color_image_message(RgbImage(4, 3), 1, ColorEncoding::kRaw, 90);
    for (const auto& [width, height] :
         {std::pair{2000000000, 2000000000}, {-4, 3}, {4, -3}, {0, 0}, {5, 3}}) {
        image.width = width;
        image.height = height;
        for (const std::int32_t format :
             std::vector<std::int32_t>{image_t::PIXEL_FORMAT_RGB, image_t::PIXEL_FORMAT_GRAY}) {
            image.pixelformat = format;
            if (width == 5 && format == image_t::PIXEL_FORMAT_GRAY) continue;  // 36 bytes hold it
            image.row_stride = 0;
            EXPECT_THAT(test::error_of([&] { color_pixels(image); }), HasSubstr("do not hold")) << width;
            EXPECT_THAT(test::error_of([&] { luma_pixels(image); }), HasSubstr("do not hold")) << width;
        }
        image.pixelformat = image_t::PIXEL_FORMAT_LE_GRAY16;
        if (width != 5) {
            EXPECT_THAT(test::error_of([&] { depth_pixels(image, false); }), HasSubstr("do not hold"));
        }
    }
    image.pixelformat = 12345;
    EXPECT_THAT(test::error_of([&] { color_pixels(image); }), HasSubstr("12345"));
    EXPECT_THAT(test::error_of([&] { depth_pixels(image, false); }), HasSubstr("12345"));
}

}  // namespace
}  // namespace planemap::messages
