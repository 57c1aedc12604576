// SPDX-License-Identifier: BSD-3-Clause
#include "messages/image_pixels.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

#include "messages/image_codec.hpp"

namespace planemap::messages {

namespace {

using bot_core::image_t;
using bot_core::images_t;

/// The index of the first image that `wanted` takes by its type; the number of images if there is none.
template <typename Wanted>
std::size_t find_image(const images_t& images, const Wanted& wanted) {
    const auto& types = images.image_types;
    return static_cast<std::size_t>(std::find_if(types.begin(), types.end(), wanted) - types.begin());
}

const image_t* image_at(const images_t& images, std::size_t index) {
    return index < images.images.size() ? &images.images[index] : nullptr;
}

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

/// Throws unless `data` holds height rows of row_bytes at the image's stride.
std::size_t checked_stride(const image_t& image, std::size_t row_bytes, const char* which) {
    const auto stride = static_cast<std::size_t>(std::max(image.row_stride, 0));
    const std::size_t used = stride == 0 ? row_bytes : stride;
    const auto height = static_cast<std::size_t>(std::max(image.height, 0));
    if (image.width <= 0 || height == 0 || used < row_bytes ||
        image.data.size() < used * (height - 1) + row_bytes) {
        throw MessageError(std::string(which) + " image: " + std::to_string(image.data.size()) +
                           " bytes do not hold " + size_text(image.width, image.height) +
                           " at a row stride of " + std::to_string(image.row_stride));
    }
    return used;
}

std::uint16_t swapped(std::uint16_t value) {
    return static_cast<std::uint16_t>(value << 8 | value >> 8);
}

/// True if the pixels are smoother with their bytes exchanged: the steps between neighbours that both have a
/// reading tell, and where these are alike, which way the depth is the nearer one.
bool is_other_endian(const DepthImage& depth) {
    std::int64_t steps = 0, swapped_steps = 0, sum = 0, swapped_sum = 0;
    for (int v = 0; v < depth.height; ++v) {
        const std::uint16_t* row = depth.row(v);
        for (int u = 0; u < depth.width; ++u) {
            sum += row[u];
            swapped_sum += swapped(row[u]);
            if (u == 0 || !is_valid_depth(row[u]) || !is_valid_depth(row[u - 1])) continue;
            steps += std::abs(row[u] - row[u - 1]);
            swapped_steps += std::abs(swapped(row[u]) - swapped(row[u - 1]));
        }
    }
    return swapped_steps != steps ? swapped_steps < steps : swapped_sum < sum;
}

/// A row of the image, its channels in the order r, g, b.
void copy_row(const image_t& image, std::size_t stride, int v, RgbImage& row) {
    const std::uint8_t* from = image.data.data() + static_cast<std::size_t>(v) * stride;
    if (image.pixelformat == image_t::PIXEL_FORMAT_GRAY) {
        for (Rgb& p : row.pixels) {
            p = {*from, *from, *from};
            ++from;
        }
        return;
    }
    std::memcpy(&row.pixels.data()->r, from, 3 * row.pixels.size());
    if (image.pixelformat == image_t::PIXEL_FORMAT_BGR) {
        for (Rgb& p : row.pixels) std::swap(p.r, p.b);
    }
}

std::size_t checked_color_stride(const image_t& image) {
    const std::size_t channels = image.pixelformat == image_t::PIXEL_FORMAT_GRAY ? 1 : 3;
    return checked_stride(image, channels * static_cast<std::size_t>(std::max(image.width, 0)), "colour");
}

/// Rows of a GRAY, RGB or BGR image, one after the other.
template <typename TakeRow>
void for_each_row(const image_t& image, std::size_t stride, const TakeRow& take) {
    RgbImage row(image.width, 1);
    for (int v = 0; v < image.height; ++v) {
        copy_row(image, stride, v, row);
        take(v, row);
    }
}

}  // namespace

bool is_depth(std::int16_t image_type) {
    return image_type == images_t::DEPTH_MM || image_type == images_t::DEPTH_MM_ZIPPED;
}

const image_t* find_depth(const images_t& images) {
    return image_at(images, find_image(images, is_depth));
}

const image_t* find_color(const images_t& images) {
    return image_at(images, find_image(images, [](std::int16_t type) { return type == images_t::LEFT; }));
}

bool depth_is_zipped(const images_t& images) {
    const std::size_t index = find_image(images, is_depth);
    return index < images.image_types.size() && images.image_types[index] == images_t::DEPTH_MM_ZIPPED;
}

void require_size(const image_t& image, const PinholeCamera& camera, const char* which) {
    if (image.width == camera.width && image.height == camera.height) return;
    throw MessageError(std::string(which) + " image is " + size_text(image.width, image.height) +
                       ", the camera info says " + size_text(camera.width, camera.height));
}

DepthImage depth_pixels(const image_t& image, bool zipped) {
    if (zipped) return decode_zipped_depth(image.data, image.width, image.height);
    const bool big_endian = image.pixelformat == kBigEndianGray16;
    if (image.pixelformat != image_t::PIXEL_FORMAT_LE_GRAY16 && !big_endian) {
        throw MessageError("depth image: pixel format " + std::to_string(image.pixelformat) +
                           " is not LE_GRAY16 or BE_GRAY16");
    }
    const std::size_t row_bytes = 2 * static_cast<std::size_t>(std::max(image.width, 0));
    const std::size_t stride = checked_stride(image, row_bytes, "depth");
    DepthImage depth(image.width, image.height);
    for (int v = 0; v < image.height; ++v) {
        std::memcpy(depth.row(v), image.data.data() + static_cast<std::size_t>(v) * stride, row_bytes);
    }
    if (big_endian && is_other_endian(depth))
        std::transform(depth.pixels.begin(), depth.pixels.end(), depth.pixels.begin(), swapped);
    return depth;
}

void require_color_format(const image_t& image) {
    const std::int32_t format = image.pixelformat;
    if (format != image_t::PIXEL_FORMAT_GRAY && format != image_t::PIXEL_FORMAT_RGB &&
        format != image_t::PIXEL_FORMAT_BGR && format != image_t::PIXEL_FORMAT_MJPEG) {
        throw MessageError("colour image: pixel format " + std::to_string(format) +
                           " is not GRAY, RGB, BGR or MJPEG");
    }
}

GrayImage luma_pixels(const image_t& image) {
    require_color_format(image);
    if (image.pixelformat == image_t::PIXEL_FORMAT_MJPEG)
        return decode_jpeg_luma(image.data, image.width, image.height);
    const std::size_t stride = checked_color_stride(image);
    GrayImage out(image.width, image.height);
    if (image.pixelformat == image_t::PIXEL_FORMAT_GRAY) {  // as it is
        for (int v = 0; v < out.height; ++v) {
            std::memcpy(out.row(v), image.data.data() + static_cast<std::size_t>(v) * stride,
                        static_cast<std::size_t>(out.width));
        }
        return out;
    }
    for_each_row(image, stride, [&](int v, const RgbImage& row) {
        std::memcpy(out.row(v), luma(row).pixels.data(), row.pixels.size());
    });
    return out;
}

RgbImage color_pixels(const image_t& image, int reduction) {
    require_color_format(image);
    if (image.pixelformat == image_t::PIXEL_FORMAT_MJPEG)
        throw MessageError("colour image: a JPEG, no pixels");
    const std::size_t stride = checked_color_stride(image);
    RgbImage out((image.width + reduction - 1) / reduction, (image.height + reduction - 1) / reduction);
    for_each_row(image, stride, [&](int v, const RgbImage& row) {
        if (v % reduction != 0) return;
        for (int u = 0; u < out.width; ++u) out(u, v / reduction) = row(u * reduction, 0);
    });
    return out;
}

}  // namespace planemap::messages
