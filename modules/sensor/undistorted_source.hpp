// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/frame_source.hpp"

namespace planemap::sensor {

/// The source as one of pinholes, for who hands its images on where nobody can say what the lens does: its
/// camera() has no distortion, JPEGs are decoded where colour has one. The source itself where there is
/// nothing to undo. Frames of the bus need no such thing: messages::Frame undoes what their camera says.
std::unique_ptr<FrameSource> undistorted(std::unique_ptr<FrameSource> source);

}  // namespace planemap::sensor
