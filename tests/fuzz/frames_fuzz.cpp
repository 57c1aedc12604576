// SPDX-License-Identifier: BSD-3-Clause
// What a module does with a frame off the bus: it is decoded, and every image of it is asked for. The first
// byte says whether the camera's depth is registered.
#include "fuzz/message.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/image_codec.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

namespace {

constexpr int kWidth = 16, kHeight = 12;

template <typename Ask>
void ask(const Ask& image) {
    try {
        image();
    } catch (const messages::MessageError&) {
    }
}

void use(const messages::Frame& frame) {
    ask([&] { require(frame.depth().width == kWidth, "depth has the camera's size"); });
    ask([&] { require(frame.depth_in_color().height == kHeight, "and in the colour camera's image"); });
    ask([&] { frame.gray(); });
    frame.seq();
    frame.color_utime();
    frame.image_bytes();
}

std::string frame(std::int64_t utime, messages::ColorEncoding color, messages::DepthEncoding depth) {
    bot_core::images_t images;
    images.utime = utime;
    images.image_types = {bot_core::images_t::LEFT, depth == messages::DepthEncoding::kRaw
                                                        ? bot_core::images_t::DEPTH_MM
                                                        : bot_core::images_t::DEPTH_MM_ZIPPED};
    images.images = {messages::color_image_message(RgbImage(kWidth, kHeight), utime, color, 50),
                     messages::depth_image_message(DepthImage(kWidth, kHeight, 1000), utime, depth)};
    messages::set_seq(images.images.back(), static_cast<std::uint32_t>(utime / 33333));
    messages::set_sender(images.images.back(), 7);
    images.n_images = 2;
    return std::string(1, color == messages::ColorEncoding::kRaw ? '\0' : '\1') + seed_of(images);
}

CameraInfo beside_color() {
    CameraInfo camera = test::sample_camera(kWidth, kHeight);
    camera.registered = false;
    camera.color_from_depth.translation().x() = 0.025;
    return camera;
}

}  // namespace

void fuzz(Bytes bytes) {
    static messages::Bus bus("memq://");
    static const messages::FrameDecoder registered(bus, test::sample_camera(kWidth, kHeight)),
        unregistered(bus, beside_color());
    if (bytes.empty()) return;
    std::vector<std::uint8_t> message = fingerprint<bot_core::images_t>();
    message.insert(message.end(), bytes.begin() + 1, bytes.end());
    ask([&] {
        use(*(bytes[0] % 2 == 0 ? registered : unregistered).decode({messages::channels::kFrame, message}));
    });
}

std::vector<std::string> seeds() {
    using messages::ColorEncoding;
    using messages::DepthEncoding;
    return {frame(33333, ColorEncoding::kRaw, DepthEncoding::kRaw),
            frame(33333, ColorEncoding::kJpeg, DepthEncoding::kZipped),
            frame(33333, ColorEncoding::kJpeg, DepthEncoding::kRaw)};
}

}  // namespace planemap::fuzz
