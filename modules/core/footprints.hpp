// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/reprojection.hpp"

namespace planemap {

/// Fills the colour pixels whose centres lie in a reading's footprint, the square of one depth pixel around
/// it on its surface. Readings of one surface share their footprints' corners, so that it has no cracks and
/// its depth is interpolated; at an edge a footprint ends where its own pixel does. Of several surfaces the
/// nearest wins, and what turns its back to the colour camera is left out. `registered` has the colour
/// camera's size and is 0 where there is nothing yet.
void fill_footprints(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection,
                     DepthImage& registered);

}  // namespace planemap
