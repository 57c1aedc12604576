// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "camera/options.hpp"
#include "core/frame_source.hpp"

namespace planemap::camera {

/// True for an input that is a camera or a camera's recording: "openni2", "openni2:URI", "openni2:SERIAL",
/// "freenect", "freenect:SERIAL", and names that end in ".oni".
bool is_camera(const std::string& input);

/// Opens such an input. Throws std::runtime_error, one line that names input and reason, if there is no such
/// camera or file, or it does not work; std::invalid_argument for bad options.
std::unique_ptr<FrameSource> open_camera(const std::string& input, const CameraRequest& request);

/// Throws std::invalid_argument: --record is for a live OpenNI2 camera, and `input` is none.
[[noreturn]] void refuse_recording(const std::string& input);

/// All cameras there are, with their modes, as lines for people: those that OpenNI2 and libfreenect find, and
/// those that are plugged in and cannot be opened, with the reason. Says so if there is none.
std::string list_cameras();

}  // namespace planemap::camera
