// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace planemap {

/// What an accelerometer beside the camera read. At rest it points up with 9.8 m/s2: the ground pushes up.
struct Acceleration {
    std::int64_t utime = 0;                                         ///< microseconds, the frames' clock
    Eigen::Vector3d acceleration_camera = Eigen::Vector3d::Zero();  ///< camera frame, m/s2
};

}  // namespace planemap
