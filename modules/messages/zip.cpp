// SPDX-License-Identifier: BSD-3-Clause
#include "messages/zip.hpp"

#include <libdeflate.h>

#include <memory>
#include <new>

namespace planemap::messages {

Unzipped unzip(std::span<const std::uint8_t> zipped, std::span<std::uint8_t> bytes) {
    struct Deleter {
        void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
    };
    thread_local std::unique_ptr<libdeflate_decompressor, Deleter> inflater(libdeflate_alloc_decompressor());
    if (!inflater) throw std::bad_alloc();
    // With no pointer for the actual size, libdeflate fails unless the stream fills the bytes exactly.
    switch (libdeflate_zlib_decompress(inflater.get(), zipped.data(), zipped.size(), bytes.data(),
                                       bytes.size(), nullptr)) {
        case LIBDEFLATE_SUCCESS:
            return Unzipped::kWhole;
        case LIBDEFLATE_SHORT_OUTPUT:
            return Unzipped::kShort;
        case LIBDEFLATE_INSUFFICIENT_SPACE:
            return Unzipped::kLong;
        default:
            return Unzipped::kCorrupt;
    }
}

std::vector<std::uint8_t> zip(std::span<const std::uint8_t> bytes, int level) {
    struct Deleter {
        void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
    };
    const std::unique_ptr<libdeflate_compressor, Deleter> deflater(libdeflate_alloc_compressor(level));
    if (!deflater) throw std::bad_alloc();
    std::vector<std::uint8_t> zipped(libdeflate_zlib_compress_bound(deflater.get(), bytes.size()));
    zipped.resize(
        libdeflate_zlib_compress(deflater.get(), bytes.data(), bytes.size(), zipped.data(), zipped.size()));
    return zipped;
}

}  // namespace planemap::messages
