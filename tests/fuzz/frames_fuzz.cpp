// SPDX-License-Identifier: BSD-3-Clause
// What a module does with frames off the bus: several images_t one after the other, each led by its length in
// two bytes, big-endian, go through the frame decoder, and of those taken every image is asked for.
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

std::string with_length(const std::string& seed) {
    return {static_cast<char>(seed.size() >> 8), static_cast<char>(seed.size() & 0xff)};
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
    const std::string seed = seed_of(images);
    return with_length(seed) + seed;
}

}  // namespace

void fuzz(Bytes bytes) {
    messages::Bus bus("memq://");
    CameraInfo camera = test::sample_camera(kWidth, kHeight);
    camera.registered = bytes.empty() || bytes[0] % 2 == 0;
    messages::FrameDecoder decoder(bus, camera);
    messages::ModuleStatus status("FUZZ");
    std::int64_t delivered = 0;
    decoder.subscribe(status, 4, [&](const std::shared_ptr<const messages::Frame>& taken) {
        use(*taken);
        ++delivered;
    });
    std::int64_t sent = 0;
    for (std::size_t at = 0; at + 2 <= bytes.size() && sent < 8; ++sent) {
        const std::size_t length = std::size_t{bytes[at]} << 8 | bytes[at + 1];
        const Bytes payload = bytes.subspan(at + 2).first(std::min(length, bytes.size() - at - 2));
        std::vector<std::uint8_t> message = fingerprint<bot_core::images_t>();
        message.insert(message.end(), payload.begin(), payload.end());
        bus.publish_bytes(messages::channels::kFrame, message);
        at += 2 + payload.size();
    }
    bus.drain();
    require(delivered <= sent, "no frame comes from nowhere");
}

std::vector<std::string> seeds() {
    using messages::ColorEncoding;
    using messages::DepthEncoding;
    return {frame(33333, ColorEncoding::kRaw, DepthEncoding::kRaw) +
                frame(66666, ColorEncoding::kJpeg, DepthEncoding::kZipped),
            frame(33333, ColorEncoding::kJpeg, DepthEncoding::kZipped),
            frame(33333, ColorEncoding::kJpeg, DepthEncoding::kRaw)};
}

}  // namespace planemap::fuzz
