// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/png.hpp"
#include "sensor/png.hpp"
#include "sensor/test_images.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_png(bytes, sensor::decode_color_png);
}

std::vector<std::string> seeds() {
    const auto pixels = [](std::size_t bytes) {
        std::vector<std::uint8_t> all(bytes);
        for (std::size_t i = 0; i < bytes; ++i) all[i] = static_cast<std::uint8_t>(i % 4);
        return all;
    };
    spng_plte palette{};
    palette.n_entries = 4;
    return {sensor::encode_png(16, 12, SPNG_COLOR_TYPE_TRUECOLOR, 8, pixels(576)),
            sensor::encode_png(16, 12, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 8, pixels(768)),
            sensor::encode_png(16, 12, SPNG_COLOR_TYPE_GRAYSCALE, 8, pixels(192)),
            sensor::encode_png(16, 12, SPNG_COLOR_TYPE_INDEXED, 8, pixels(192), &palette)};
}

}  // namespace planemap::fuzz
