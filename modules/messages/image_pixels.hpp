// SPDX-License-Identifier: BSD-3-Clause
// The images of bot_core.images_t to pixels, whichever of the ecosystem's ways they were written in.
#pragma once

#include <bot_core/images_t.hpp>
#include <cstdint>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "messages/error.hpp"

namespace planemap::messages {

/// Pixel format of 16-bit big-endian grey (as PIXEL_FORMAT_LE_GRAY16, which lcmtypes has). Common converters
/// write it over little-endian pixels.
inline constexpr std::int32_t kBigEndianGray16 = 357;

/// Whether an entry of images_t::image_types is depth as we read it (DEPTH_MM or DEPTH_MM_ZIPPED).
bool is_depth(std::int16_t image_type);

/// The first depth image, and the first colour image (LEFT); nullptr if there is none.
const bot_core::image_t* find_depth(const bot_core::images_t& images);
const bot_core::image_t* find_color(const bot_core::images_t& images);
/// Whether the first depth image is a zlib stream.
bool depth_is_zipped(const bot_core::images_t& images);

/// Throws MessageError unless the image has the camera's size; `which` is what it is called.
void require_size(const bot_core::image_t& image, const PinholeCamera& camera, const char* which);

/// Depth pixels as they were sent, in the sender's units: a zlib stream of little-endian rows if `zipped`,
/// else rows of LE_GRAY16, or of kBigEndianGray16: there the bytes decide, not the name, since depth is
/// smooth when read the right way round. Throws MessageError for anything else and for bytes that do not
/// hold the image's size.
DepthImage depth_pixels(const bot_core::image_t& image, bool zipped);

/// Throws MessageError unless the image's format is GRAY, RGB, BGR or MJPEG.
void require_color_format(const bot_core::image_t& image);
/// Luma of a colour image of one of these formats. Throws MessageError for bytes that do not hold its size.
GrayImage luma_pixels(const bot_core::image_t& image);
/// Colours of a GRAY, RGB or BGR image, of every `reduction`-th pixel (sizes are rounded up). Throws as
/// luma_pixels().
RgbImage color_pixels(const bot_core::image_t& image, int reduction = 1);

}  // namespace planemap::messages
