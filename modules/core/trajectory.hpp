// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace planemap {

/// Poses in order of time.
using Trajectory = std::vector<StampedPose>;

/// Reads a trajectory with timestamps, world_from_camera in metres, in TUM's form or another that
/// read_trajectory_file() knows. Throws std::runtime_error naming file, line and reason; also for KITTI's
/// form, which has no timestamps. The result is sorted by time; what the user should know of the file is
/// added to the notes, a line each.
Trajectory read_trajectory(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr);

/// Writes a TUM trajectory (timestamps with six decimals, values with seven, beside and renamed, so a reader
/// never sees half a file). Throws std::runtime_error naming the file.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

/// Writes the trajectories of a run's components into a folder under their names (component_file(), at most
/// kMostComponentFiles), and removes those that an earlier run had more. Throws as write_trajectory().
void write_trajectories(const std::filesystem::path& folder, const std::vector<Trajectory>& trajectories);

/// The pose at a time: the trajectory's own, or interpolated between the two around it if they are at most
/// max_gap_us apart; nothing elsewhere. Sorted input.
std::optional<Pose> pose_at(const Trajectory& trajectory, std::int64_t utime, std::int64_t max_gap_us);

}  // namespace planemap
