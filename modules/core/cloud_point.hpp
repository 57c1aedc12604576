// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/image.hpp"

namespace planemap {

/// A point of a coloured cloud, and which plane of a map it is of.
struct CloudPoint {
    static constexpr Rgb kNoColor{128, 128, 128};  ///< where no colour is known
    static constexpr int kNoPlane = -1;

    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< world, metres
    Rgb color = kNoColor;
    int plane = kNoPlane;  ///< id; kNoPlane: no plane explains it
};

}  // namespace planemap
