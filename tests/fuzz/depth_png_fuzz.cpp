// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/png.hpp"
#include "sensor/png.hpp"
#include "sensor/test_images.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_png(bytes, sensor::decode_depth_png);
}

std::vector<std::string> seeds() {
    std::vector<std::uint8_t> pixels(16 * 12 * 2);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 7);
    return {sensor::encode_png(16, 12, SPNG_COLOR_TYPE_GRAYSCALE, 16, pixels)};
}

}  // namespace planemap::fuzz
