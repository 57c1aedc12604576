// SPDX-License-Identifier: BSD-3-Clause
#include "convert/pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string_view>

#include "core/yuv.hpp"
#include "messages/kinect_frame.hpp"
#include "sensor/jpeg.hpp"
#include "sensor/png.hpp"

namespace planemap::convert {

namespace {

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

void require_size(const RawImage& image, const PinholeCamera& camera) {
    if (image.width == camera.width && image.height == camera.height) return;
    throw std::runtime_error("the image is " + size_text(image.width, image.height) + ", its camera " +
                             size_text(camera.width, camera.height));
}

/// Throws unless the bytes hold the rows.
void require_bytes(const RawImage& image, std::size_t bytes_a_pixel) {
    const std::size_t row = bytes_a_pixel * static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    if (image.step >= row && image.step < (std::size_t{1} << 32) &&
        image.data.size() >= image.step * (height - 1) + row)
        return;
    throw std::runtime_error(std::to_string(image.data.size()) + " bytes in rows of " +
                             std::to_string(image.step) + " do not hold " +
                             size_text(image.width, image.height) + " pixels of " + image.encoding);
}

const std::uint8_t* row_of(const RawImage& image, int v) {
    return image.data.data() + static_cast<std::size_t>(v) * image.step;
}

template <typename T>
T number_at(const std::uint8_t* bytes, bool big_endian) {
    std::uint8_t ordered[sizeof(T)];
    std::memcpy(ordered, bytes, sizeof(T));
    if (big_endian) std::reverse(ordered, ordered + sizeof(T));
    T value;
    std::memcpy(&value, ordered, sizeof(T));
    return value;
}

std::uint16_t in_units(double metres) {
    const double units = metres * kFloatUnits;
    return std::isfinite(units) && units >= 1 && units < 65535
               ? static_cast<std::uint16_t>(std::lround(units))
               : std::uint16_t{0};
}

/// How the channels of a pixel lie.
struct Interleaved {
    std::size_t bytes, r, g, b;
};
const std::map<std::string, Interleaved>& interleaved() {
    static const std::map<std::string, Interleaved> kAll = {
        {"rgb8", {3, 0, 1, 2}},  {"8UC3", {3, 2, 1, 0}},  {"bgr8", {3, 2, 1, 0}}, {"rgba8", {4, 0, 1, 2}},
        {"bgra8", {4, 2, 1, 0}}, {"mono8", {1, 0, 0, 0}}, {"8UC1", {1, 0, 0, 0}}};
    return kAll;
}

/// Where messages::from_bayer()'s pattern begins.
const std::map<std::string, std::pair<int, int>>& mosaics() {
    static const std::map<std::string, std::pair<int, int>> kAll = {
        {"bayer_grbg8", {0, 0}}, {"bayer_rggb8", {1, 0}}, {"bayer_bggr8", {0, 1}}, {"bayer_gbrg8", {1, 1}}};
    return kAll;
}

bool is_yuv(const std::string& encoding) {
    return encoding == "yuv422" || encoding == "yuyv" || encoding == "yuv422_yuy2";
}

RgbImage from_yuv(const RawImage& image) {
    require_bytes(image, 2);
    if (image.width % 2 != 0) throw std::runtime_error("a 4:2:2 image of an odd width");
    const std::size_t luma = image.encoding == "yuv422" ? 1 : 0;
    RgbImage out(image.width, image.height);
    for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
            const std::uint8_t* pair = row_of(image, v) + 4 * static_cast<std::ptrdiff_t>(u / 2);
            out(u, v) =
                rgb_of_yuv(pair[luma + 2 * static_cast<std::size_t>(u % 2)], pair[1 - luma], pair[3 - luma]);
        }
    }
    return out;
}

}  // namespace

bool is_depth_encoding(const std::string& encoding) {
    return encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1";
}

bool is_color_encoding(const std::string& encoding) {
    return interleaved().count(encoding) > 0 || mosaics().count(encoding) > 0 || is_yuv(encoding);
}

DepthImage depth_of(const RawImage& image, const PinholeCamera& camera) {
    if (!is_depth_encoding(image.encoding))
        throw std::runtime_error("encoding \"" + image.encoding + "\" is no depth");
    require_size(image, camera);
    const bool is_float = image.encoding == "32FC1";
    require_bytes(image, is_float ? 4 : 2);
    DepthImage depth(image.width, image.height);
    for (int v = 0; v < image.height; ++v) {
        const std::uint8_t* row = row_of(image, v);
        for (int u = 0; u < image.width; ++u) {
            const std::ptrdiff_t at = u;
            depth(u, v) =
                is_float ? in_units(static_cast<double>(number_at<float>(row + 4 * at, image.big_endian)))
                         : number_at<std::uint16_t>(row + 2 * at, image.big_endian);
        }
    }
    return depth;
}

RgbImage color_of(const RawImage& image, const PinholeCamera& camera) {
    if (!is_color_encoding(image.encoding))
        throw std::runtime_error("encoding \"" + image.encoding + "\" is no colour that is read");
    require_size(image, camera);
    if (is_yuv(image.encoding)) return from_yuv(image);
    if (const auto mosaic = mosaics().find(image.encoding); mosaic != mosaics().end()) {
        require_bytes(image, 1);
        GrayImage gray(image.width, image.height);
        for (int v = 0; v < image.height; ++v)
            std::memcpy(gray.row(v), row_of(image, v), static_cast<std::size_t>(image.width));
        return messages::from_bayer(gray, mosaic->second.first, mosaic->second.second);
    }
    const Interleaved& pixel = interleaved().at(image.encoding);
    require_bytes(image, pixel.bytes);
    RgbImage out(image.width, image.height);
    for (int v = 0; v < image.height; ++v) {
        const std::uint8_t* from = row_of(image, v);
        for (int u = 0; u < image.width; ++u, from += pixel.bytes)
            out(u, v) = {from[pixel.r], from[pixel.g], from[pixel.b]};
    }
    return out;
}

DepthImage depth_of_compressed(const std::string& format, std::span<const std::uint8_t> data,
                               const PinholeCamera& camera) {
    constexpr std::size_t kHeader = 12;
    if (data.size() <= kHeader)
        throw std::runtime_error("compressed depth of " + std::to_string(data.size()) + " bytes");
    const std::string_view png(reinterpret_cast<const char*>(data.data()) + kHeader, data.size() - kHeader);
    DepthImage depth = sensor::decode_depth_png(png, camera.width, camera.height);
    if (!format.starts_with("32FC1")) return depth;
    const double a = static_cast<double>(number_at<float>(data.data() + 4, false));
    const double b = static_cast<double>(number_at<float>(data.data() + 8, false));
    for (std::uint16_t& value : depth.pixels)
        value = value == 0 ? std::uint16_t{0} : in_units(a / (value - b));
    return depth;
}

void read_compressed_color(std::span<const std::uint8_t> data, const PinholeCamera& camera,
                           SensorFrame& frame) {
    const std::string_view bytes(reinterpret_cast<const char*>(data.data()), data.size());
    if (sensor::is_jpeg(bytes)) {
        sensor::check_jpeg(bytes, camera.width, camera.height);
        frame.color_jpeg.assign(data.begin(), data.end());
    } else if (sensor::is_png(bytes)) {
        frame.color = sensor::decode_color_png(bytes, camera.width, camera.height);
    } else {
        throw std::runtime_error("neither a PNG nor a JPEG");
    }
}

}  // namespace planemap::convert
