// SPDX-License-Identifier: BSD-3-Clause
// Compressed images as they travel: JPEG by libjpeg-turbo, zipped depth by libdeflate. Every decoder checks
// the size that the caller expects before it allocates, and throws MessageError with the reason for anything
// corrupt or cut short.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.hpp"
#include "messages/error.hpp"

namespace planemap::messages {

/// Luma of a JPEG, which costs a fraction of its colours.
GrayImage decode_jpeg_luma(std::span<const std::uint8_t> jpeg, int width, int height);
/// All of its colours, or one pixel for `reduction` x `reduction` (1, 2, 4 or 8; sizes are rounded up): the
/// more it is reduced the less it costs.
RgbImage decode_jpeg_colors(std::span<const std::uint8_t> jpeg, int width, int height, int reduction = 1);
/// quality: 1 to 100.
std::vector<std::uint8_t> encode_jpeg(const RgbImage& image, int quality);

/// Luma of colour pixels (ITU-R BT.601, as JPEG's).
GrayImage luma(const RgbImage& image);

/// A zlib stream of 16-bit little-endian rows.
DepthImage decode_zipped_depth(std::span<const std::uint8_t> zipped, int width, int height);
std::vector<std::uint8_t> encode_zipped_depth(const DepthImage& depth, int level = 1);

}  // namespace planemap::messages
