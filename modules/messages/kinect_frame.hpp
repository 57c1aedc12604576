// SPDX-License-Identifier: BSD-3-Clause
// The frames of older logs of a Kinect v1 (kinect.frame_msg_t on KINECT_FRAME) as bot_core.images_t.
#pragma once

#include <bot_core/images_t.hpp>
#include <cstdint>
#include <kinect/frame_msg_t.hpp>

#include "core/image.hpp"
#include "messages/error.hpp"

namespace planemap::messages {

/// The same images as bot_core.images_t has them: depth in millimetres, zipped as it came where it came so;
/// colour as the JPEG that it came as, or as RGB. Raw 11-bit depth becomes millimetres
/// (kinect_millimetres()), a Bayer mosaic RGB. An image that is not there (VIDEO_NONE, DEPTH_NONE) is left
/// out. Stamps are the images' own where they lie within a second of the frame's (some drivers wrote ticks of
/// the device there), else the frame's. Throws MessageError that names field and reason for a format that is
/// not known and for bytes that do not hold the size.
bot_core::images_t to_images(const kinect::frame_msg_t& frame);

/// Whether there is a depth image in it.
bool has_depth(const kinect::frame_msg_t& frame);

/// Depth of a raw 11-bit reading of a Kinect v1 in millimetres, with the factory's constants as OpenNI and
/// libfreenect have them (reference plane at 1.2 m, its pixels 0.1042 mm, baseline 75 mm); 0 for readings
/// without depth (2047) and beyond 10 m.
std::uint16_t kinect_millimetres(std::uint16_t raw);

/// Colours of a Bayer mosaic: the missing ones are means of their neighbours. Its rows are g r g r and
/// b g b g, as a Kinect v1's, from pixel (right, down) of that pattern on.
RgbImage from_bayer(const GrayImage& mosaic, int right = 0, int down = 0);

}  // namespace planemap::messages
