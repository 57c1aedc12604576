// SPDX-License-Identifier: BSD-3-Clause
// Raw images by the names that ROS gives their encodings, and compressed ones as its image_transport writes
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/camera.hpp"
#include "core/frame_source.hpp"
#include "core/image.hpp"

namespace planemap::convert {

/// An image in rows of `step` bytes.
struct RawImage {
    int width = 0, height = 0;
    std::size_t step = 0;
    bool big_endian = false;
    std::string encoding;  ///< "16UC1", "rgb8" and so on
    std::span<const std::uint8_t> data;
};

bool is_depth_encoding(const std::string& encoding);
bool is_color_encoding(const std::string& encoding);

/// Units a metre that 32FC1 depth, which is in metres, is written with: a fifth of a millimetre.
inline constexpr double kFloatUnits = 5000;

/// Depth of 16UC1 and mono16 as it is, of 32FC1 in kFloatUnits; what is not finite or does not fit is 0.
/// Throws std::runtime_error (reason only) for another encoding or size, and bytes that do not hold it.
DepthImage depth_of(const RawImage& image, const PinholeCamera& camera);
/// Colours of rgb8, bgr8, rgba8, bgra8, mono8, 8UC1, 8UC3, the four bayer_*8, yuv422 (UYVY) and yuyv. Throws
/// as depth_of().
RgbImage color_of(const RawImage& image, const PinholeCamera& camera);

/// The PNG of a compressedDepth message: its header of 12 bytes holds the parameters of quantised 32FC1
/// depth. Throws as depth_of().
DepthImage depth_of_compressed(const std::string& format, std::span<const std::uint8_t> data,
                               const PinholeCamera& camera);
/// A JPEG stays one, a PNG becomes pixels. Throws as depth_of().
void read_compressed_color(std::span<const std::uint8_t> data, const PinholeCamera& camera,
                           SensorFrame& frame);

}  // namespace planemap::convert
