// SPDX-License-Identifier: BSD-3-Clause
// Which keyframes hang together: see KeyframePose::component.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap {

/// The components of a trajectory, the one with the most keyframes first, of as many the older.
std::vector<int> components(const KeyframeTrajectory& trajectory);

/// The component with the most keyframes: what results are about; 0 without keyframes.
int largest_component(const KeyframeTrajectory& trajectory);

/// The trajectory of one component; its world_from_odom says nothing unless the newest keyframe is of it.
KeyframeTrajectory of_component(const KeyframeTrajectory& trajectory, int component);

/// Components that results are written of; a camera that is lost again and again makes many.
constexpr std::size_t kMostComponentFiles = 20;

/// The name of a result of a component, numbered from 1 in the order of components(): trajectory.txt of the
/// first, trajectory_2.txt of the second ...
std::string component_file(const std::string& name, std::size_t number);

}  // namespace planemap
