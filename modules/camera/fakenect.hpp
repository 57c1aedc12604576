// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>

#include "core/frame_source.hpp"

namespace planemap::camera {

/// Colour pixels of a frame whose colour is a JPEG.
using DecodeColor = std::function<RgbImage(const SensorFrame& frame, const PinholeCamera& camera)>;

/// Writes a source as a recording that libfreenect's fakenect library plays in place of a Kinect v1, in a
/// folder that must not be there yet: INDEX.txt, d-SECONDS-TICKS.pgm with raw 11-bit depth,
/// r-SECONDS-TICKS.ppm, and device.json. Made beside and renamed. `max_frames` 0: all. Returns the frames
/// that were written. Depth of a Kinect is 640 x 480, so others are refused; it keeps the steps of raw
/// readings (3 mm at 1 m, 45 mm at 4 m). Throws std::invalid_argument for another size, std::runtime_error
/// that names the file that cannot be written.
std::size_t write_fakenect(FrameSource& source, const std::filesystem::path& folder, std::size_t max_frames,
                           const DecodeColor& decode);

}  // namespace planemap::camera
