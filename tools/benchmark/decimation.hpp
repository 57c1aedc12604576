// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap::benchmark {

/// Every step-th pixel of every step-th row, and the camera that sees them; its colour camera is scaled
/// alike, so that depth can still be registered to it. Precondition: step >= 1.
DepthImage decimated(const DepthImage& depth, int step);
CameraInfo decimated(const CameraInfo& camera, int step);

}  // namespace planemap::benchmark
