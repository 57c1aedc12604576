// SPDX-License-Identifier: BSD-3-Clause
#include "messages/image_codec.hpp"

#include <turbojpeg.h>

#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <string>

#include "messages/zip.hpp"

namespace planemap::messages {

static_assert(std::endian::native == std::endian::little,
              "depth travels as little-endian rows and is copied as it is");
static_assert(sizeof(Rgb) == 3);

namespace {

struct TurboDeleter {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using Turbo = std::unique_ptr<void, TurboDeleter>;

/// One decompressor a thread: making one costs more than a small image.
Turbo& decompressor() {
    thread_local Turbo handle;
    if (!handle) handle.reset(tjInitDecompress());
    if (!handle) throw std::bad_alloc();
    return handle;
}

/// Throws with libjpeg-turbo's reason. The decompressor goes too: after a corrupt image it does not read the
/// next one.
[[noreturn]] void fail(Turbo& handle) {
    const std::string reason = tjGetErrorStr2(handle.get());
    handle.reset();
    throw MessageError("JPEG: " + reason);
}

/// Pixels of the type in one of libjpeg-turbo's formats, one for `reduction` x `reduction`.
template <typename Pixel>
Image<Pixel> decode_jpeg(std::span<const std::uint8_t> jpeg, int width, int height, int format,
                         int reduction = 1) {
    Turbo& handle = decompressor();
    int w = 0, h = 0, subsampling = 0, colorspace = 0;
    if (tjDecompressHeader3(handle.get(), jpeg.data(), jpeg.size(), &w, &h, &subsampling, &colorspace) != 0) {
        fail(handle);
    }
    if (w != width || h != height) {
        throw MessageError("JPEG: the image is " + std::to_string(w) + "x" + std::to_string(h) +
                           ", expected " + std::to_string(width) + "x" + std::to_string(height));
    }
    // Accurate transforms, so that pixels are the same whatever decodes them; a warning (cut short, corrupt)
    // is an error.
    const int flags = TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING;
    Image<Pixel> image((width + reduction - 1) / reduction, (height + reduction - 1) / reduction);
    if (tjDecompress2(handle.get(), jpeg.data(), jpeg.size(),
                      reinterpret_cast<unsigned char*>(image.pixels.data()), image.width, 0, image.height,
                      format, flags) != 0) {
        fail(handle);
    }
    return image;
}

}  // namespace

GrayImage decode_jpeg_luma(std::span<const std::uint8_t> jpeg, int width, int height) {
    return decode_jpeg<std::uint8_t>(jpeg, width, height, TJPF_GRAY);
}

RgbImage decode_jpeg_colors(std::span<const std::uint8_t> jpeg, int width, int height, int reduction) {
    static_assert(sizeof(Rgb) == 3);
    return decode_jpeg<Rgb>(jpeg, width, height, TJPF_RGB, reduction);
}

std::vector<std::uint8_t> encode_jpeg(const RgbImage& image, int quality) {
    const Turbo handle(tjInitCompress());
    if (!handle) throw std::bad_alloc();
    std::vector<std::uint8_t> jpeg(tjBufSize(image.width, image.height, TJSAMP_420));
    unsigned char* out = jpeg.data();
    unsigned long size = jpeg.size();
    if (tjCompress2(handle.get(), &image.pixels.data()->r, image.width, 0, image.height, TJPF_RGB, &out,
                    &size, TJSAMP_420, quality, TJFLAG_NOREALLOC) != 0) {
        throw std::runtime_error(std::string("JPEG: ") + tjGetErrorStr2(handle.get()));
    }
    jpeg.resize(size);
    return jpeg;
}

GrayImage luma(const RgbImage& image) {
    GrayImage gray(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb p = image.pixels[i];
        gray.pixels[i] = static_cast<std::uint8_t>((19595 * p.r + 38470 * p.g + 7471 * p.b + 32768) >> 16);
    }
    return gray;
}

DepthImage decode_zipped_depth(std::span<const std::uint8_t> zipped, int width, int height) {
    DepthImage depth(width, height);
    switch (unzip(zipped, {reinterpret_cast<std::uint8_t*>(depth.pixels.data()), depth.pixels.size() * 2})) {
        case Unzipped::kWhole:
            return depth;
        case Unzipped::kShort:
            throw MessageError("zipped depth: fewer pixels than the image's size says");
        case Unzipped::kLong:
            throw MessageError("zipped depth: more pixels than the image's size says");
        default:
            throw MessageError("zipped depth: corrupt or cut short");
    }
}

std::vector<std::uint8_t> encode_zipped_depth(const DepthImage& depth, int level) {
    return zip({reinterpret_cast<const std::uint8_t*>(depth.pixels.data()), depth.pixels.size() * 2}, level);
}

}  // namespace planemap::messages
