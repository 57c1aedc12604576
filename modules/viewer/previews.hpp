// SPDX-License-Identifier: BSD-3-Clause
// Small pictures of a frame for people who look on.
#pragma once

#include <span>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/region.hpp"

namespace planemap::viewer {

/// The least reduction of 1, 2, 4 and 8 that brings the longer side of an image to `longest` pixels; 8 if
/// none does.
int reduction_to(int width, int height, int longest);

/// Depth in colours, near ones warm and far ones cold over the camera's range; no reading is black. One pixel
/// for `reduction` x `reduction`, the reading at its corner.
RgbImage depth_preview(const DepthImage& depth, const CameraInfo& camera, int reduction);

/// The regions in the depth image, each in a colour of its own (id_color() of its index) on a grey picture of
/// the depth: a reading belongs to the first region whose plane it lies on and whose outline it is in.
/// `regions` are in the camera frame.
RgbImage region_preview(const DepthImage& depth, const CameraInfo& camera,
                        std::span<const PlanarRegion> regions, int reduction);

}  // namespace planemap::viewer
