// SPDX-License-Identifier: BSD-3-Clause
#include "messages/frame_decoder.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "messages/channels.hpp"
#include "messages/sample_messages.hpp"

namespace planemap {
namespace {

using test::encoded;
using test::sample_camera;

bot_core::images_t frame_message(const DepthImage& depth, const RgbImage& color, ColorEncoding c,
                                 DepthEncoding d) {
    bot_core::images_t images;
    images.utime = 50;
    images.image_types = {bot_core::images_t::LEFT, d == DepthEncoding::kRaw
                                                        ? std::int16_t{bot_core::images_t::DEPTH_MM}
                                                        : std::int16_t{bot_core::images_t::DEPTH_MM_ZIPPED}};
    images.images = {color_image_message(color, 40, c, 95), depth_image_message(depth, 50, d)};
    set_seq(images.images.back(), 17);
    images.n_images = 2;
    return images;
}

RawMessage raw(const std::vector<std::uint8_t>& bytes) {
    return {channels::kFrame, bytes, 0};
}

TEST(FrameDecoder, AllEncodingsGiveTheSameFrame) {
    Bus bus("memq://");
    FrameDecoder decoder(bus, sample_camera());
    const DepthImage depth(64, 48, 1234);
    const RgbImage color(64, 48, Rgb{100, 100, 100});
    for (const auto c : {ColorEncoding::kRaw, ColorEncoding::kJpeg}) {
        for (const auto d : {DepthEncoding::kRaw, DepthEncoding::kZipped}) {
            const auto bytes = encoded(frame_message(depth, color, c, d));
            const auto frame = decoder.decode(raw(bytes));
            ASSERT_NE(frame, nullptr);
            EXPECT_EQ(frame->utime(), 50);
            EXPECT_EQ(frame->color_utime(), 40);
            EXPECT_EQ(frame->seq(), 17u);
            EXPECT_EQ(frame->depth().pixels, depth.pixels);
            ASSERT_NE(frame->gray(), nullptr);
            for (const auto g : frame->gray()->pixels) EXPECT_NEAR(g, 100, 1);
        }
    }
}

TEST(FrameDecoder, SharesAFrameAmongThoseWhoAsk) {
    Bus bus("memq://");
    FrameDecoder decoder(bus, sample_camera());
    const auto bytes = encoded(frame_message(DepthImage(64, 48, 900), RgbImage(64, 48), ColorEncoding::kRaw,
                                             DepthEncoding::kZipped));
    const auto a = decoder.decode(raw(bytes)), b = decoder.decode(raw(bytes));
    EXPECT_EQ(a.get(), b.get());
    EXPECT_EQ(&a->depth(), &b->depth());
}

TEST(FrameDecoder, WaitsForTheCameraAndTakesItFromTheBus) {
    Bus bus("memq://");
    FrameDecoder decoder(bus);
    const auto bytes = encoded(
        frame_message(DepthImage(64, 48, 900), RgbImage(64, 48), ColorEncoding::kRaw, DepthEncoding::kRaw));
    EXPECT_EQ(decoder.decode(raw(bytes)), nullptr);
    bus.publish(channels::kCameraInfo, to_message(sample_camera(), 1, 0));
    bus.drain();
    EXPECT_NE(decoder.decode(raw(bytes)), nullptr);
}

TEST(FrameDecoder, RegistersUnregisteredDepthOnce) {
    Bus bus("memq://");
    CameraInfo camera = sample_camera();
    camera.registered = false;
    camera.color_from_depth.translation() = Eigen::Vector3d(0.1, 0, 0);
    FrameDecoder decoder(bus, camera);
    const auto bytes = encoded(
        frame_message(DepthImage(64, 48, 1000), RgbImage(64, 48), ColorEncoding::kRaw, DepthEncoding::kRaw));
    const auto frame = decoder.decode(raw(bytes));
    // 0.1 m at 1 m with a focal length of 50 pixels: a shift of 5 pixels.
    EXPECT_EQ(frame->depth_in_color()(4, 10), 0);
    EXPECT_EQ(frame->depth_in_color()(5, 10), 1000);
    EXPECT_EQ(&frame->depth_in_color(), &frame->depth_in_color());
}

TEST(FrameDecoder, FramesThatDoNotAddUpAreErrors) {
    Bus bus("memq://");
    FrameDecoder decoder(bus, sample_camera());
    const auto refused = [&](const std::function<void(bot_core::images_t&)>& spoil,
                             DepthEncoding d = DepthEncoding::kRaw, ColorEncoding c = ColorEncoding::kRaw) {
        auto message = frame_message(DepthImage(64, 48, 900), RgbImage(64, 48), c, d);
        spoil(message);
        const auto bytes = encoded(message);
        EXPECT_THROW(
            {
                const auto frame = decoder.decode(raw(bytes));
                frame->depth();
                frame->gray();
            },
            MessageError);
    };
    const auto shrink = [](bot_core::image_t& image) {
        image.data.resize(image.data.size() / 2);
        image.size = static_cast<std::int32_t>(image.data.size());
    };
    refused([](auto& m) { m.image_types[1] = bot_core::images_t::DISPARITY; });
    refused([](auto& m) { m.images[1].width = 640; });
    refused([](auto& m) { m.images[1].width = -64; });
    refused([](auto& m) { m.images[1].row_stride = 1; });
    refused([](auto& m) { m.images[1].row_stride = 0x7fffffff; });
    refused([](auto& m) { m.images[1].pixelformat = 0; });
    refused([&](auto& m) { shrink(m.images[1]); });
    refused([&](auto& m) { shrink(m.images[1]); }, DepthEncoding::kZipped);
    refused([](auto& m) { m.images[0].height = 47; });
    refused([](auto& m) { m.images[0].pixelformat = 123; });
    refused([&](auto& m) { shrink(m.images[0]); });
    refused([&](auto& m) { shrink(m.images[0]); }, DepthEncoding::kRaw, ColorEncoding::kJpeg);
}

}  // namespace
}  // namespace planemap
