// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/png_rows.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace planemap::sensor {

namespace {

constexpr std::size_t kSignature = 8, kHeader = 13;

struct Chunk {
    std::string_view type, data;
};

std::uint32_t big_endian(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
    return value;
}

/// Takes a whole chunk whose checksum holds off the front.
std::optional<Chunk> next_chunk(std::string_view& bytes) {
    constexpr std::size_t kAround = 12;  // length, type, checksum
    if (bytes.size() < kAround) return std::nullopt;
    const std::size_t length = big_endian(bytes);
    if (length > std::min(bytes.size() - kAround, kMaxPngChunk)) return std::nullopt;
    const std::string_view summed = bytes.substr(4, 4 + length);
    if (libdeflate_crc32(0, summed.data(), summed.size()) != big_endian(bytes.substr(8 + length)))
        return std::nullopt;
    bytes.remove_prefix(kAround + length);
    return Chunk{summed.substr(0, 4), summed.substr(4)};
}

bool is_header_of(const Chunk& chunk, const PngFormat& format) {
    if (chunk.type != "IHDR" || chunk.data.size() != kHeader) return false;
    const auto byte = [&](std::size_t i) {
        return static_cast<int>(static_cast<std::uint8_t>(chunk.data[i]));
    };
    const bool is_plain = byte(10) == 0 && byte(11) == 0 && byte(12) == 0;  // deflated, filtered, in one pass
    return big_endian(chunk.data) == static_cast<std::uint32_t>(format.width) &&
           big_endian(chunk.data.substr(4)) == static_cast<std::uint32_t>(format.height) &&
           byte(8) == format.bit_depth && byte(9) == format.color_type && is_plain;
}

/// The chunks of pixels, which follow each other; none if the file is not whole, or has others that matter.
std::vector<std::string_view> pixel_chunks(std::string_view bytes, const PngFormat& format) {
    std::vector<std::string_view> pixels;
    if (bytes.size() < kSignature) return {};
    bytes.remove_prefix(kSignature);
    const std::optional<Chunk> header = next_chunk(bytes);
    if (!header || !is_header_of(*header, format)) return {};
    bool is_over = false;
    while (const std::optional<Chunk> chunk = next_chunk(bytes)) {
        if (chunk->type == "IDAT") {
            if (is_over) return {};
            pixels.push_back(chunk->data);
            continue;
        }
        is_over = !pixels.empty();
        if (chunk->type == "IEND") return chunk->data.empty() ? pixels : std::vector<std::string_view>{};
        const bool is_critical = (chunk->type[0] & 0x20) == 0;
        if (is_critical) return {};
    }
    return {};
}

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
};

/// Whether the chunks are one zlib stream of exactly so many bytes.
bool inflate(const std::vector<std::string_view>& chunks, std::span<std::uint8_t> out) {
    static thread_local const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(
        libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    std::string_view stream = chunks.front();
    std::string joined;
    if (chunks.size() > 1) {
        for (const std::string_view chunk : chunks) joined += chunk;
        stream = joined;
    }
    return libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), out.data(),
                                      out.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

std::uint8_t sum(int a, int b) {
    return static_cast<std::uint8_t>(a + b);
}

/// The bytes of a pixel side by side, with room for their sums.
using Lanes = std::int16_t __attribute__((vector_size(8)));
using Bytes = std::uint8_t __attribute__((vector_size(4)));

template <std::size_t Step>
Lanes load(const std::uint8_t* pixel) {
    Bytes bytes{};
    std::memcpy(&bytes, pixel, Step);
    return __builtin_convertvector(bytes, Lanes);
}

/// Predicts from the nearest of left, above and above left; a pixel's bytes at once, since each pixel waits
/// for the one before it.
template <std::size_t Step>
void unfilter_paeth(std::span<std::uint8_t> row, std::span<const std::uint8_t> above) {
    const auto magnitude = [](Lanes lanes) { return lanes < 0 ? -lanes : lanes; };
    Lanes left{}, above_left{};
    for (std::size_t i = 0; i + Step <= row.size(); i += Step) {
        const Lanes up = load<Step>(above.data() + i);
        const Lanes to_left = magnitude(up - above_left), to_above = magnitude(left - above_left);
        const Lanes to_above_left = magnitude(left + up - 2 * above_left);
        // Selected, not branched on: which is nearest is as good as random.
        const Lanes nearer = to_left <= to_above ? left : up;
        const Lanes least = to_left <= to_above ? to_left : to_above;
        const Lanes predicted = least <= to_above_left ? nearer : above_left;
        left = (load<Step>(row.data() + i) + predicted) & 255;
        above_left = up;
        const Bytes bytes = __builtin_convertvector(left, Bytes);
        std::memcpy(row.data() + i, &bytes, Step);
    }
}

/// With the number of bytes a pixel known to the compiler, the row unrolls.
template <std::size_t Step>
bool unfilter(int filter, std::span<std::uint8_t> row, std::span<const std::uint8_t> above) {
    const std::size_t n = row.size(), first = std::min(Step, n);
    switch (filter) {
        case 0:
            return true;
        case 1:
            for (std::size_t i = first; i < n; ++i) row[i] = sum(row[i], row[i - Step]);
            return true;
        case 2:
            for (std::size_t i = 0; i < n; ++i) row[i] = sum(row[i], above[i]);
            return true;
        case 3:
            for (std::size_t i = 0; i < first; ++i) row[i] = sum(row[i], above[i] / 2);
            for (std::size_t i = first; i < n; ++i) row[i] = sum(row[i], (row[i - Step] + above[i]) / 2);
            return true;
        case 4:
            unfilter_paeth<Step>(row, above);
            return true;
        default:
            return false;
    }
}

}  // namespace

bool unfilter_row(int filter, int bytes_per_pixel, std::span<std::uint8_t> row,
                  std::span<const std::uint8_t> above) {
    switch (bytes_per_pixel) {
        case 1:
            return unfilter<1>(filter, row, above);
        case 2:
            return unfilter<2>(filter, row, above);
        case 3:
            return unfilter<3>(filter, row, above);
        case 4:
            return unfilter<4>(filter, row, above);
        default:
            throw std::invalid_argument("unfilter_row: bytes per pixel");
    }
}

bool decode_png_rows(std::string_view bytes, const PngFormat& format, std::span<std::uint8_t> rows) {
    const std::size_t row_bytes = format.row_bytes(), height = static_cast<std::size_t>(format.height);
    if (rows.size() != row_bytes * height) throw std::invalid_argument("decode_png_rows: size of rows");
    const std::vector<std::string_view> chunks = pixel_chunks(bytes, format);
    if (chunks.empty() || rows.empty()) return false;
    static thread_local std::vector<std::uint8_t> filtered;  // each row behind its filter's number
    filtered.resize((row_bytes + 1) * height);
    if (!inflate(chunks, filtered)) return false;
    const std::vector<std::uint8_t> zeros(row_bytes);
    std::span<const std::uint8_t> above = zeros;
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t* from = filtered.data() + (row_bytes + 1) * y;
        const std::span<std::uint8_t> row = rows.subspan(row_bytes * y, row_bytes);
        std::memcpy(row.data(), from + 1, row_bytes);
        if (!unfilter_row(*from, format.bytes_per_pixel, row, above)) return false;
        above = row;
    }
    return true;
}

}  // namespace planemap::sensor
