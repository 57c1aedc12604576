// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/png.hpp"

#include <spng.h>

#include <bit>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "core/files.hpp"
#include "sensor/png_rows.hpp"

namespace planemap::sensor {

namespace {

struct FreeContext {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

void check(int code, const std::string& doing) {
    if (code != 0) throw std::runtime_error(doing + ": " + spng_strerror(code));
}

std::string size_text(long long width, long long height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

/// A decoder over the bytes, with its header read and its size checked before anything is allocated.
Context open(std::string_view bytes, int width, int height, spng_ihdr& header) {
    if (!is_png(bytes)) throw std::runtime_error("not a PNG");
    Context context(spng_ctx_new(0));
    if (!context) throw std::bad_alloc();
    check(spng_set_crc_action(context.get(), SPNG_CRC_ERROR, SPNG_CRC_ERROR), "PNG");
    check(spng_set_image_limits(context.get(), kMaxImageSide, kMaxImageSide), "PNG");
    check(spng_set_chunk_limits(context.get(), kMaxPngChunk, kMaxPngChunk), "PNG");
    check(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()), "PNG");
    check(spng_get_ihdr(context.get(), &header), "bad PNG header");
    if (header.width != static_cast<unsigned>(width) || header.height != static_cast<unsigned>(height)) {
        throw std::runtime_error("the image is " + size_text(header.width, header.height) +
                                 ", the camera's is " + size_text(width, height));
    }
    return context;
}

/// Decodes all pixels into `out`, and reads on to the end of the file so that a missing end is noticed.
void decode(spng_ctx* context, int format, void* out, std::size_t bytes, bool* end_missing) {
    constexpr const char* kDoing = "cut short or corrupt PNG";
    std::size_t needed = 0;
    check(spng_decoded_image_size(context, format, &needed), "bad PNG");
    if (needed != bytes) throw std::runtime_error("bad PNG: unexpected size of the decoded image");
    check(spng_decode_image(context, out, bytes, format, 0), kDoing);
    const int end = spng_decode_chunks(context);
    if (end_missing != nullptr) *end_missing = end == SPNG_IO_EOF;
    if (end_missing == nullptr || end != SPNG_IO_EOF) check(end, kDoing);
}

/// What nearly all files are, in half the time that spng takes; samples of 16 bits as they are in the file.
/// Nothing for others: spng knows what is wrong with them, or reads what is unusual.
template <typename T>
std::optional<Image<T>> decode_usual(std::string_view bytes, int width, int height, int color_type) {
    const auto fits = [](int side) { return side > 0 && side <= kMaxImageSide; };
    if (!fits(width) || !fits(height) || !is_png(bytes)) return std::nullopt;
    const int bit_depth = std::is_same_v<T, std::uint16_t> ? 16 : 8;
    Image<T> image(width, height);
    const std::span<std::uint8_t> rows(reinterpret_cast<std::uint8_t*>(image.pixels.data()),
                                       image.pixels.size() * sizeof(T));
    const PngFormat format{width, height, bit_depth, color_type, static_cast<int>(sizeof(T))};
    if (!decode_png_rows(bytes, format, rows)) return std::nullopt;
    return image;
}

std::uint16_t from_big_endian(std::uint16_t raw) {
    if constexpr (std::endian::native == std::endian::big) return raw;
    return static_cast<std::uint16_t>(raw << 8 | raw >> 8);
}

const char* type_name(int color_type) {
    switch (color_type) {
        case SPNG_COLOR_TYPE_GRAYSCALE:
            return "greyscale";
        case SPNG_COLOR_TYPE_TRUECOLOR:
            return "RGB";
        case SPNG_COLOR_TYPE_INDEXED:
            return "palette";
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return "greyscale and alpha";
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return "RGBA";
        default:
            return "unknown";
    }
}

template <typename T>
void write_png(const std::filesystem::path& file, const Image<T>& image, int color_type, int bit_depth) {
    Context context(spng_ctx_new(SPNG_CTX_ENCODER));
    if (!context) throw std::bad_alloc();
    spng_ihdr header{};
    header.width = static_cast<std::uint32_t>(image.width);
    header.height = static_cast<std::uint32_t>(image.height);
    header.bit_depth = static_cast<std::uint8_t>(bit_depth);
    header.color_type = static_cast<std::uint8_t>(color_type);
    const std::string doing = file.string() + ": cannot write PNG";
    check(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1), doing);
    check(spng_set_ihdr(context.get(), &header), doing);
    check(spng_encode_image(context.get(), image.pixels.data(), image.pixels.size() * sizeof(T), SPNG_FMT_PNG,
                            SPNG_ENCODE_FINALIZE),
          doing);
    std::size_t size = 0;
    int error = 0;
    const std::unique_ptr<void, void (*)(void*)> bytes(spng_get_png_buffer(context.get(), &size, &error),
                                                       std::free);
    check(error, doing);
    write_file(file, {static_cast<const char*>(bytes.get()), size});
}

}  // namespace

bool is_png(std::string_view bytes) {
    return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

DepthImage decode_depth_png(std::string_view bytes, int width, int height, bool* end_missing) {
    if (auto usual = decode_usual<std::uint16_t>(bytes, width, height, SPNG_COLOR_TYPE_GRAYSCALE)) {
        for (std::uint16_t& raw : usual->pixels) raw = from_big_endian(raw);
        if (end_missing != nullptr) *end_missing = false;
        return *std::move(usual);
    }
    spng_ihdr header{};
    const Context context = open(bytes, width, height, header);
    if (header.color_type != SPNG_COLOR_TYPE_GRAYSCALE || header.bit_depth != 16) {
        throw std::runtime_error(std::string("a depth image is 16-bit greyscale, this one is ") +
                                 std::to_string(header.bit_depth) + "-bit " + type_name(header.color_type));
    }
    DepthImage depth(width, height);
    decode(context.get(), SPNG_FMT_PNG, depth.pixels.data(), depth.pixels.size() * sizeof(std::uint16_t),
           end_missing);
    return depth;
}

RgbImage decode_color_png(std::string_view bytes, int width, int height, bool* end_missing) {
    static_assert(sizeof(Rgb) == 3);
    if (auto usual = decode_usual<Rgb>(bytes, width, height, SPNG_COLOR_TYPE_TRUECOLOR)) {
        if (end_missing != nullptr) *end_missing = false;
        return *std::move(usual);
    }
    spng_ihdr header{};
    const Context context = open(bytes, width, height, header);
    if (header.bit_depth != 8) {
        throw std::runtime_error("a colour image has 8 bits a channel, this one has " +
                                 std::to_string(header.bit_depth));
    }
    RgbImage color(width, height);
    decode(context.get(), SPNG_FMT_RGB8, color.pixels.data(), color.pixels.size() * sizeof(Rgb), end_missing);
    return color;
}

void write_depth_png(const std::filesystem::path& file, const DepthImage& depth) {
    write_png(file, depth, SPNG_COLOR_TYPE_GRAYSCALE, 16);
}

void write_color_png(const std::filesystem::path& file, const RgbImage& color) {
    write_png(file, color, SPNG_COLOR_TYPE_TRUECOLOR, 8);
}

}  // namespace planemap::sensor
