// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "core/pose.hpp"

namespace planemap {

/// Poses in order of time.
using Trajectory = std::vector<StampedPose>;

/// Reads a TUM trajectory: lines `timestamp tx ty tz qx qy qz qw` (seconds, or the unit that the size of the
/// stamps says, see read_stamp(); world_from_camera, metres), # comments and blank lines skipped. Throws
/// std::runtime_error naming file, line and reason for a file that cannot be read, a line with fewer than
/// eight numbers, a non-finite value, a quaternion far from unit length, or a timestamp that is none or is
/// not in the unit of the first. The result is sorted by time.
Trajectory read_trajectory(const std::filesystem::path& file);

/// Writes a TUM trajectory (timestamps with six decimals, values with seven, beside and renamed, so a reader
/// never sees half a file). Throws std::runtime_error naming the file.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace planemap
