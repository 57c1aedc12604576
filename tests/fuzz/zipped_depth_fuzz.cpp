// SPDX-License-Identifier: BSD-3-Clause
// The input as a zlib stream; and zipped, so that the stream is good and holds any number of bytes.
#include <libdeflate.h>

#include <memory>

#include "fuzz/fuzz.hpp"
#include "messages/image_codec.hpp"

namespace planemap::fuzz {

namespace {

constexpr int kWidth = 16, kHeight = 12;

bool decodes(Bytes zipped) {
    try {
        const DepthImage image = messages::decode_zipped_depth(zipped, kWidth, kHeight);
        require(image.width == kWidth && image.height == kHeight, "the size is as asked for");
        return true;
    } catch (const messages::MessageError&) {
        return false;
    }
}

std::vector<std::uint8_t> zipped(Bytes bytes) {
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(1), &libdeflate_free_compressor);
    std::vector<std::uint8_t> out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
    out.resize(
        libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
    return out;
}

}  // namespace

void fuzz(Bytes bytes) {
    decodes(bytes);
    require(decodes(zipped(bytes)) == (bytes.size() == 2 * kWidth * kHeight), "just whole images are taken");
}

std::vector<std::string> seeds() {
    const std::vector<std::uint8_t> good = messages::encode_zipped_depth(DepthImage(kWidth, kHeight, 1000));
    return {{good.begin(), good.end()}, std::string(2 * kWidth * kHeight, 'd')};
}

}  // namespace planemap::fuzz
