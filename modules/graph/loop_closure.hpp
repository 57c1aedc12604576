// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/geometry/pose.hpp"

namespace planemap::graph {

/// Two keyframes that saw the same place.
struct LoopClosure {
    int from_id = -1, to_id = -1;               ///< from the older to the newer one
    std::int64_t from_utime = 0, to_utime = 0;  ///< Keyframe::utime of both
    Pose from_from_to = Pose::Identity();       ///< newer camera in the older camera's frame
    Matrix6d covariance = Matrix6d::Zero();     ///< translation, rotation; newer camera's frame
    int matches = 0;                            ///< descriptors matched
    int inliers = 0;                            ///< points that agree
    double weight =
        1;  ///< in the last optimisation, 0 to 1: near 0 when the rest of the graph contradicts it
};

}  // namespace planemap::graph
