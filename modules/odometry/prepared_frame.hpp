// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/region.hpp"
#include "odometry/flow.hpp"
#include "odometry/odometry.hpp"
#include "odometry/planar_patches.hpp"

namespace planemap::odometry {

/// A frame prepared for tracking. The images are those of the OdometryFrame and live as long.
struct PreparedFrame {
    std::int64_t utime = 0;     ///< depth time, microseconds
    double color_offset_s = 0;  ///< colour time minus depth time
    double readout_s = 0;       ///< see Alignment
    const GrayImage* gray = nullptr;
    const DepthImage* depth = nullptr;
    const CameraInfo* camera = nullptr;
    FlowPyramid pyramid;  ///< empty without colour
    std::vector<DepthSample> samples;
    std::vector<PlanarRegion> regions;  ///< the valid ones
};

/// Throws std::invalid_argument when depth or camera is missing or an image has not the colour camera's size.
void check(const OdometryFrame& frame);

/// Precondition: check() does not throw. `readout_s` is what is known of the shutter, see Alignment.
PreparedFrame prepare(const OdometryOptions& options, const OdometryFrame& frame, double readout_s);

/// Microseconds to seconds.
inline double seconds(std::int64_t microseconds) {
    return static_cast<double>(microseconds) * 1e-6;
}

}  // namespace planemap::odometry
