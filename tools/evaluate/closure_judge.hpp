// SPDX-License-Identifier: BSD-3-Clause
// Loop closures against the true poses.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/trajectory.hpp"

namespace planemap::evaluation {

/// Two moments that a method says it knows the relative pose of.
struct Closure {
    std::int64_t from_utime = 0, to_utime = 0;  ///< moments of the two poses, microseconds
    Pose from_from_to = Pose::Identity();       ///< the later camera in the earlier camera's frame
};

/// How far a closure's relative pose may be from the true one.
struct ClosureTolerance {
    double base_m = 0.10;
    double share_of_distance = 0.02;  ///< on top, times the true distance between the two poses
    double angle_deg = 5;
};

/// How far a closure is from the truth.
struct ClosureError {
    double metres = 0, degrees = 0;
    bool is_false = false;
};

/// Compares a relative pose with the true one, both of a later camera in an earlier camera's frame.
ClosureError closure_error(const Pose& estimate, const Pose& truth, const ClosureTolerance& tolerance = {});

/// Compares a closure's relative pose with the true one, see ClosureTolerance; nothing where no true pose is
/// near one of its moments.
std::optional<ClosureError> judge_closure(const Trajectory& truth, const Closure& closure,
                                          const ClosureTolerance& tolerance = {});

}  // namespace planemap::evaluation
