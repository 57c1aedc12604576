// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "fuzz/fuzz.hpp"
#include "messages/image_codec.hpp"
#include "sensor/jpeg.hpp"

namespace planemap::fuzz {

namespace {

constexpr int kWidth = 16, kHeight = 12;

}  // namespace

void fuzz(Bytes bytes) {
    sensor::is_jpeg(as_text(bytes));
    try {
        sensor::check_jpeg(as_text(bytes), kWidth, kHeight);
    } catch (const std::runtime_error&) {
    }
    try {
        const GrayImage image = messages::decode_jpeg_luma(bytes, kWidth, kHeight);
        require(image.width == kWidth && image.height == kHeight, "the size is as asked for");
    } catch (const messages::MessageError&) {
    }
}

std::vector<std::string> seeds() {
    RgbImage image(kWidth, kHeight);
    for (int v = 0; v < kHeight; ++v)
        for (int u = 0; u < kWidth; ++u)
            image(u, v) = {static_cast<std::uint8_t>(9 * u), static_cast<std::uint8_t>(v), 99};
    const std::vector<std::uint8_t> jpeg = messages::encode_jpeg(image, 60);
    return {{jpeg.begin(), jpeg.end()}};
}

}  // namespace planemap::fuzz
