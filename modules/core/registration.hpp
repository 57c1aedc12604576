// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap {

/// Depth as the colour camera would see it: each valid reading is moved through color_from_depth to its
/// colour pixel, the nearest one wins, and its value becomes the depth along the colour camera's axis, in the
/// same units. Returns an image of the colour camera's size; pixels that no reading lands on are 0 (invalid).
/// A registered sensor's image is returned as it is when both cameras have the same size. Precondition: depth
/// has the size of camera.depth.
DepthImage register_depth(const DepthImage& depth, const CameraInfo& camera);

}  // namespace planemap
