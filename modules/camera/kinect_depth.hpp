// SPDX-License-Identifier: BSD-3-Clause
// A Kinect v1's raw depth: 11 bits of disparity, 2047 for none.
#pragma once

#include <cstdint>

#include "core/camera.hpp"

namespace planemap::camera {

inline constexpr std::uint16_t kNoRawDepth = 2047;

/// Millimetres of a raw reading; 0 for one that means no distance within 10 m. PrimeSense's formula with the
/// constants that most of these Kinects store: emitter 7.5 cm beside the camera, zero plane at 1.2 m with
/// pixels of 0.1042 mm at 1280 x 1024, constant shift 200.
std::uint16_t raw_to_mm(std::uint16_t raw);
/// The raw reading that is nearest to a distance; kNoRawDepth for 0 and for distances without one.
std::uint16_t mm_to_raw(std::uint16_t mm);

/// The Kinect v1 by its design: depth as the same constants say, colour as it is published (525 pixels). When
/// depth is not registered, colour is 25 mm beside it.
CameraInfo kinect_camera(bool is_registered);

}  // namespace planemap::camera
