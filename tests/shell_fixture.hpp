// SPDX-License-Identifier: BSD-3-Clause
// What the tests of LCM shells share: a memq:// bus, sample frames, and bytes that are no message.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/frame_decoder.hpp"

namespace planemap::test {

class ShellTest : public testing::Test {
  protected:
    static constexpr int kWidth = 320, kHeight = 240;

    static CameraInfo camera() {
        CameraInfo camera;
        camera.serial = "test";
        camera.depth = camera.color = {kWidth, kHeight, 280, 280, 159.5, 119.5};
        return camera;
    }

    /// A wall at 2 m with squares of many shades, moved sideways by `shift` metres.
    static bot_core::images_t frame(std::int64_t utime, double shift = 0) {
        RgbImage color(kWidth, kHeight);
        DepthImage depth(kWidth, kHeight);
        for (int v = 0; v < kHeight; ++v) {
            for (int u = 0; u < kWidth; ++u) {
                // Turned, so that no corner falls on the pixel grid the same way as another.
                const double right = (u - 159.5) / 280 * 2 + shift, down = (v - 119.5) / 280 * 2;
                const double x = 0.955 * right - 0.296 * down, y = 0.296 * right + 0.955 * down;
                auto cell = static_cast<std::uint64_t>((x + 50) / 0.2) << 32 |
                            static_cast<std::uint64_t>((y + 50) / 0.2);
                cell = (cell ^ cell >> 31) * 0x9e3779b97f4a7c15u;
                cell = (cell ^ cell >> 29) * 0xbf58476d1ce4e5b9u;
                const bool gap = std::fmod(x + 50, 0.2) < 0.07 || std::fmod(y + 50, 0.2) < 0.07;
                const auto noise = noise_of(u, v, utime);
                const auto level = static_cast<std::uint8_t>((gap ? 20 : (cell >> 40) % 160 + 80) + noise);
                color(u, v) = {level, level, level};
                depth(u, v) = static_cast<std::uint16_t>(2000 + noise);
            }
        }
        bot_core::images_t images;
        images.utime = utime;
        images.image_types = {bot_core::images_t::LEFT, bot_core::images_t::DEPTH_MM};
        images.images = {messages::color_image_message(color, utime, messages::ColorEncoding::kRaw, 90),
                         messages::depth_image_message(depth, utime, messages::DepthEncoding::kRaw)};
        images.n_images = 2;
        return images;
    }

    /// 0 or 1: two images of a still scene differ, as a sensor's do.
    static unsigned noise_of(int u, int v, std::int64_t utime) {
        auto x = static_cast<std::uint64_t>(utime) * 0x9e3779b97f4a7c15u +
                 static_cast<std::uint64_t>(v * kWidth + u);
        x = (x ^ x >> 31) * 0xbf58476d1ce4e5b9u;
        return static_cast<unsigned>(x >> 50 & 1);
    }

    void publish_camera() {
        bus_.publish(messages::channels::kCameraInfo, messages::to_message(camera(), 0, 0));
    }

    /// Bytes that no decoder may take, on a channel: empty, garbage, and a good message cut short and spoilt.
    template <typename T>
    void publish_corrupt(const char* channel, const T& good) {
        std::vector<std::uint8_t> bytes(static_cast<std::size_t>(good.getEncodedSize()));
        good.encode(bytes.data(), 0, good.getEncodedSize());
        bus_.publish_bytes(channel, std::vector<std::uint8_t>(3, 0));
        bus_.publish_bytes(channel, std::vector<std::uint8_t>(5000, 0xff));
        bus_.publish_bytes(channel, std::span(bytes).first(bytes.size() / 2));
        bytes.resize(bytes.size() + 1);
        bus_.publish_bytes(channel, bytes);
    }
    static constexpr int kCorrupt = 4;

    /// Collects all messages of a type on a channel.
    template <typename T>
    std::shared_ptr<std::vector<T>> collect(const char* channel) {
        auto all = std::make_shared<std::vector<T>>();
        bus_.subscribe(
            channel, [all](const messages::RawMessage& m) { all->push_back(messages::decode<T>(m.bytes)); });
        return all;
    }

    messages::Bus bus_{"memq://"};
};

}  // namespace planemap::test
