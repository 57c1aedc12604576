// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "core/frame_source.hpp"

namespace planemap::sensor {

/// Changes a frame's colour pixels, which are `camera`'s, and decodes them for that where they are a JPEG.
/// Where they cannot be, the frame goes on without colour, and the result says so.
void change_color(SensorFrame& frame, ReadResult& result, const PinholeCamera& camera,
                  const std::function<void(RgbImage&)>& change);

}  // namespace planemap::sensor
