// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "core/frame_source.hpp"

namespace planemap::convert {

/// The same frames with colour made smaller by the least whole factor that brings the depth camera's focal
/// lengths to at least 0.3 of the colour camera's, as CameraInfo::validate() wants it: each pixel is the mean
/// of those that it covers. A source for which nothing is to be done is given back as it is. The source's
/// camera need not be valid in this one respect; the result's is. Throws std::invalid_argument as validate().
std::unique_ptr<FrameSource> with_color_small_enough(std::unique_ptr<FrameSource> source);

}  // namespace planemap::convert
