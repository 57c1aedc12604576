// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/geometry/pose.hpp"

namespace planemap::odometry {

/// Where something else than the camera says that the robot's body is, in a frame of its own that drifts
/// smoothly. How far it may be off is MotionPriorOptions'.
struct MotionPrior {
    std::int64_t utime = 0;  ///< by the frames' clock, microseconds
    Pose local_from_body = Pose::Identity();
};

/// What became of the motion prior for one frame.
enum class PriorUse : std::int8_t {
    kNone,           ///< nothing was ever heard, or the frame was lost
    kNotNeeded,      ///< the camera sees all directions, and the prior agrees
    kFilled,         ///< it filled the directions that the camera does not see
    kNoMount,        ///< camera.json does not say how the body lies about the camera
    kStale,          ///< it does not reach the frame, or not back to its keyframe
    kContradictory,  ///< it is further from what the camera sees than both allow: not used
    kDistrusted,     ///< it agrees where it can be told, but has contradicted too often before: not used
};

}  // namespace planemap::odometry
