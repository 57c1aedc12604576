// SPDX-License-Identifier: BSD-3-Clause
#include "messages/kinect_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

#include "messages/convert.hpp"
#include "messages/image_codec.hpp"

namespace planemap::messages {

namespace {

using bot_core::image_t;
using bot_core::images_t;

constexpr int kMaxSide = 4096;             // a Kinect v1 has 1280 pixels
constexpr std::size_t kMostOfZlib = 1032;  // times that a zlib stream can grow
constexpr std::int64_t kStampDistanceUs = 1000000;
constexpr std::uint16_t kNoReading = 2047, kFarthestMm = 10000;

[[noreturn]] void refuse(const std::string& what) {
    throw MessageError("kinect frame: " + what);
}

void require_size(int width, int height, const char* which) {
    if (width >= 1 && height >= 1 && width <= kMaxSide && height <= kMaxSide) return;
    refuse(std::string(which) + " image of " + std::to_string(width) + "x" + std::to_string(height) +
           " pixels; sides are 1 to " + std::to_string(kMaxSide));
}

void require_bytes(std::size_t bytes, std::size_t expected, const char* which) {
    if (bytes == expected) return;
    refuse(std::string(which) + " image of " + std::to_string(bytes) + " bytes instead of " +
           std::to_string(expected));
}

std::int64_t stamp(std::int64_t image, std::int64_t frame) {
    // Differences of stamps that are near each other only: those of a device's ticks may be anything.
    const bool near = image > frame - kStampDistanceUs && image < frame + kStampDistanceUs;
    return near ? image : frame;
}

std::array<std::uint16_t, 2048> millimetre_table() {
    std::array<std::uint16_t, 2048> table{};
    for (std::uint16_t raw = 0; raw < kNoReading; ++raw) {
        // Shift against the reference plane in its pixels of 1/4, then similar triangles; centimetres.
        constexpr double kConstShift = 800, kSubpixels = 4, kOffset = 0.375;
        constexpr double kPixel = 0.1042, kReference = 120, kBaseline = 7.5;
        const double shift = ((raw - kConstShift) / kSubpixels - kOffset) * kPixel;
        if (shift >= kBaseline) continue;  // beyond infinity
        const double mm = 10 * (shift * kReference / (kBaseline - shift) + kReference);
        if (mm > 0 && mm <= kFarthestMm) table[raw] = static_cast<std::uint16_t>(std::lround(mm));
    }
    return table;
}

DepthImage depth_of(const kinect::depth_msg_t& depth) {
    const std::size_t bytes =
        2 * static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height);
    if (depth.compression == kinect::depth_msg_t::COMPRESSION_ZLIB)
        return decode_zipped_depth(depth.depth_data, depth.width, depth.height);
    require_bytes(depth.depth_data.size(), bytes, "depth");
    DepthImage image(depth.width, depth.height);
    std::memcpy(image.pixels.data(), depth.depth_data.data(), bytes);
    return image;
}

void require_depth(const kinect::depth_msg_t& depth) {
    using Depth = kinect::depth_msg_t;
    require_size(depth.width, depth.height, "depth");
    const std::int8_t format = depth.depth_data_format, compression = depth.compression;
    if (format != Depth::DEPTH_11BIT && format != Depth::DEPTH_REGISTERED && format != Depth::DEPTH_MM)
        refuse("depth_data_format " + std::to_string(format) + " is not 11BIT (0), REGISTERED (4) or MM (5)");
    if (compression != Depth::COMPRESSION_NONE && compression != Depth::COMPRESSION_ZLIB)
        refuse("compression " + std::to_string(compression) + " is not NONE (0) or ZLIB (1)");
    const std::size_t bytes =
        2 * static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height);
    if (compression == Depth::COMPRESSION_ZLIB && bytes > kMostOfZlib * depth.depth_data.size())
        refuse("zipped depth of " + std::to_string(depth.depth_data.size()) + " bytes cannot hold " +
               std::to_string(depth.width) + "x" + std::to_string(depth.height) + " pixels");
}

image_t depth_message(const kinect::depth_msg_t& depth, std::int64_t utime, std::int16_t& type) {
    const bool zipped = depth.compression == kinect::depth_msg_t::COMPRESSION_ZLIB;
    require_depth(depth);
    if (zipped && depth.depth_data_format != kinect::depth_msg_t::DEPTH_11BIT) {  // as it is
        type = images_t::DEPTH_MM_ZIPPED;
        return zipped_depth_message(depth.depth_data, depth.width, depth.height, utime);
    }
    DepthImage image = depth_of(depth);
    if (depth.depth_data_format == kinect::depth_msg_t::DEPTH_11BIT)
        std::transform(image.pixels.begin(), image.pixels.end(), image.pixels.begin(), kinect_millimetres);
    type = images_t::DEPTH_MM;
    return depth_image_message(image, utime, DepthEncoding::kRaw);
}

image_t color_message(const kinect::image_msg_t& image, std::int64_t utime) {
    using Color = kinect::image_msg_t;
    require_size(image.width, image.height, "colour");
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    switch (image.image_data_format) {
        case Color::VIDEO_RGB_JPEG:
            return jpeg_image_message(image.image_data, image.width, image.height, utime);
        case Color::VIDEO_RGB: {
            require_bytes(image.image_data.size(), 3 * pixels, "colour");
            RgbImage rgb(image.width, image.height);
            std::memcpy(rgb.pixels.data(), image.image_data.data(), 3 * pixels);
            return color_image_message(rgb, utime, ColorEncoding::kRaw, 0);
        }
        case Color::VIDEO_BAYER: {
            require_bytes(image.image_data.size(), pixels, "colour");
            GrayImage mosaic(image.width, image.height);
            std::memcpy(mosaic.pixels.data(), image.image_data.data(), pixels);
            return color_image_message(from_bayer(mosaic), utime, ColorEncoding::kRaw, 0);
        }
        default:
            refuse("image_data_format " + std::to_string(image.image_data_format) +
                   " is not RGB (0), BAYER (1), RGB_JPEG (100) or NONE (101)");
    }
}

}  // namespace

std::uint16_t kinect_millimetres(std::uint16_t raw) {
    static const std::array<std::uint16_t, 2048> kTable = millimetre_table();
    return raw < kTable.size() ? kTable[raw] : std::uint16_t{0};
}

RgbImage from_bayer(const GrayImage& mosaic, int right, int down) {
    RgbImage out(mosaic.width, mosaic.height);
    // Row 0 is g r g r, row 1 b g b g: 0, 1 and 2 are r, g and b.
    const auto color_at = [&](int u, int v) {
        const int row = v + down;
        return (u + right + row) % 2 == 0 ? 1 : row % 2 == 0 ? 0 : 2;
    };
    for (int v = 0; v < mosaic.height; ++v) {
        for (int u = 0; u < mosaic.width; ++u) {
            int sum[3] = {}, count[3] = {};
            for (int dv = -1; dv <= 1; ++dv) {
                for (int du = -1; du <= 1; ++du) {
                    if (!mosaic.contains(u + du, v + dv)) continue;
                    const int color = color_at(u + du, v + dv);
                    sum[color] += mosaic(u + du, v + dv);
                    ++count[color];
                }
            }
            const int own = color_at(u, v);
            sum[own] = mosaic(u, v);
            count[own] = 1;
            const auto mean = [&](int c) {
                return static_cast<std::uint8_t>(count[c] > 0 ? (sum[c] + count[c] / 2) / count[c] : 0);
            };
            out(u, v) = {mean(0), mean(1), mean(2)};
        }
    }
    return out;
}

bool has_depth(const kinect::frame_msg_t& frame) {
    return frame.depth.depth_data_format != kinect::depth_msg_t::DEPTH_NONE;
}

images_t to_images(const kinect::frame_msg_t& frame) {
    checked_utime(frame.timestamp, "kinect frame.timestamp");
    images_t images;
    images.utime = frame.timestamp;
    if (frame.image.image_data_format != kinect::image_msg_t::VIDEO_NONE) {
        images.image_types.push_back(images_t::LEFT);
        images.images.push_back(color_message(frame.image, stamp(frame.image.timestamp, frame.timestamp)));
    }
    if (has_depth(frame)) {
        images.utime = stamp(frame.depth.timestamp, frame.timestamp);
        std::int16_t type = 0;
        images.images.push_back(depth_message(frame.depth, images.utime, type));
        images.image_types.push_back(type);
    }
    images.n_images = static_cast<std::int32_t>(images.images.size());
    return images;
}

}  // namespace planemap::messages
