// SPDX-License-Identifier: BSD-3-Clause
// Encoded images for tests.
#pragma once

#include <spng.h>
#include <turbojpeg.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "core/image.hpp"

namespace planemap::sensor {

/// Any PNG: raw pixels (host-endian) of the given type and depth.
inline std::string encode_png(int width, int height, spng_color_type type, int bit_depth,
                              const std::vector<std::uint8_t>& pixels, const spng_plte* palette = nullptr) {
    spng_ctx* context = spng_ctx_new(SPNG_CTX_ENCODER);
    spng_ihdr header{};
    header.width = static_cast<std::uint32_t>(width);
    header.height = static_cast<std::uint32_t>(height);
    header.color_type = static_cast<std::uint8_t>(type);
    header.bit_depth = static_cast<std::uint8_t>(bit_depth);
    spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1);
    spng_set_ihdr(context, &header);
    if (palette != nullptr) {
        spng_plte copy = *palette;
        spng_set_plte(context, &copy);
    }
    spng_encode_image(context, pixels.data(), pixels.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    std::size_t size = 0;
    int error = 0;
    void* bytes = spng_get_png_buffer(context, &size, &error);
    std::string png(static_cast<const char*>(bytes), error == 0 ? size : 0);
    std::free(bytes);
    spng_ctx_free(context);
    return png;
}

inline std::string encode_depth_png(const DepthImage& depth) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(depth.pixels.data());
    return encode_png(depth.width, depth.height, SPNG_COLOR_TYPE_GRAYSCALE, 16,
                      {bytes, bytes + 2 * depth.pixels.size()});
}

inline std::string encode_jpeg(int width, int height) {
    std::vector<std::uint8_t> pixels(std::size_t{3} * static_cast<std::size_t>(width) *
                                     static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 7);
    tjhandle encoder = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    tjCompress2(encoder, pixels.data(), width, 0, height, TJPF_RGB, &bytes, &size, TJSAMP_420, 90, 0);
    std::string jpeg(reinterpret_cast<const char*>(bytes), size);
    tjFree(bytes);
    tjDestroy(encoder);
    return jpeg;
}

/// A depth image with a different value in each pixel.
inline DepthImage numbered_depth(int width, int height) {
    DepthImage depth(width, height);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
        depth.pixels[i] = static_cast<std::uint16_t>(i * 257 + 1);
    }
    return depth;
}

}  // namespace planemap::sensor
