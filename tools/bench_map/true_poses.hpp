// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/keyframe.hpp"
#include "core/trajectory.hpp"

namespace planemap::bench_map {

/// The keyframes' poses (ids and utimes are read) from a trajectory of the colour camera, at
/// their utimes by given_pose(); keyframes without one are left out.
KeyframeTrajectory at_poses(const std::vector<Keyframe>& keyframes, const Trajectory& trajectory);

/// The rigid motion that lays one trajectory's keyframes on another's with least squares over their positions
/// (metres) and rotations (a radian counts about as a metre), over the ids that both have. Nothing without
/// any.
std::optional<Pose> alignment(const KeyframeTrajectory& to, const KeyframeTrajectory& from);

}  // namespace planemap::bench_map
