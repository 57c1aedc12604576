// SPDX-License-Identifier: BSD-3-Clause
// What a live OpenNI2 camera and a .oni file have in common.
#pragma once

#include <OpenNI.h>

#include <string>
#include <vector>

#include "camera/options.hpp"
#include "core/image.hpp"

namespace planemap::camera {

/// OpenNI2 with its drivers, for as long as it lives. Throws std::runtime_error if it cannot be had.
class OpenNi2Library {
  public:
    OpenNi2Library();
    ~OpenNi2Library();
    OpenNi2Library(const OpenNi2Library&) = delete;
    OpenNi2Library& operator=(const OpenNi2Library&) = delete;
};

/// What OpenNI2 says of its last failure, in one line.
std::string openni2_error();

/// A frame's pixels, whatever the stride.
DepthImage depth_image(const openni::VideoFrameRef& frame);
/// RGB, YUV 4:2:2 or grey values as RGB. Precondition: is_color_format() of its mode.
RgbImage color_image(const openni::VideoFrameRef& frame);
bool is_color_format(openni::PixelFormat format);

/// "640x480 at 30 Hz, 1 mm"
std::string mode_text(const openni::VideoMode& mode);

/// The camera that the streams are, by their fields of view; `color` is null without a colour stream. With a
/// description it is that, and std::invalid_argument is thrown where the streams are another's: sizes, units,
/// registration. Adds to `notes` what was assumed.
CameraInfo camera_info(const std::string& name, const openni::VideoStream& depth,
                       const openni::VideoStream* color, bool is_registered, const CameraRequest& request,
                       std::vector<std::string>& notes);

}  // namespace planemap::camera
