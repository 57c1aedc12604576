// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap {

/// Depth as the colour camera would see it, in the same units: each valid reading is moved through
/// color_from_depth and fills its footprint, the square of one depth pixel on its surface, with the depth
/// along the colour camera's axis; the nearest surface wins. So a surface has no holes, whichever of the two
/// images is finer, and nothing is filled across an edge or further than half a reading beside it.
/// - A colour pixel finer than a reading gets the depth interpolated at its centre (footprints.hpp).
/// - One as coarse or coarser gets the nearest reading that lands in it, and where 1.5 or more land in each
///   the mean of those on the nearest surface: the nearest of many would be too near by their noise.
/// Pixels that no footprint reaches are 0 (invalid). A registered sensor's image is returned as it is when
/// both cameras are the same. Preconditions: depth has the size of camera.depth, and the camera is valid.
DepthImage register_depth(const DepthImage& depth, const CameraInfo& camera);

}  // namespace planemap
