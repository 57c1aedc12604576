// SPDX-License-Identifier: BSD-3-Clause
// Trajectories as files hold them, in the forms that others write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/trajectory.hpp"

namespace planemap {

enum class TrajectoryFormat { kTum, kEuroc, kKitti };

/// "TUM", "EuRoC" or "KITTI".
const char* format_name(TrajectoryFormat format);

struct TrajectoryFile {
    TrajectoryFormat format = TrajectoryFormat::kTum;
    Trajectory poses;  ///< of KITTI's, which has no timestamps: pose i at i seconds
    /// A line of what the user should know: how many poses share a stamp with another.
    std::vector<std::string> notes;
};

/// Reads a trajectory, world_from_camera in metres, a pose a line, in one of three forms, which the first
/// line of numbers tells apart:
/// - TUM: `timestamp tx ty tz qx qy qz qw`, separated by blanks or commas;
/// - EuRoC: comma-separated `timestamp, px, py, pz, qw, qx, qy, qz`, with the columns named by a header line
///   (`#timestamp [ns], p_x, ...`), or 17 columns and more;
/// - KITTI: the 12 numbers of [R | t] row by row, no timestamp.
/// A header line that names a timestamp, a position and a quaternion says the order of the columns in any
/// file. Timestamps are in the unit of the header's brackets, else in the one that their size tells
/// (read_stamp()). Comments (#) and blank lines are skipped, text after the numbers too. The result is
/// sorted by time.
/// Throws std::runtime_error naming file, line and reason: a form that is none of these (by its name where it
/// has one), lines of different forms, a value that is not finite, a position beyond 1e8 m, a quaternion
/// whose length is off 1 by more than 0.01, a matrix that is no rotation, a timestamp beyond 64 bits of
/// microseconds.
TrajectoryFile read_trajectory_file(const std::filesystem::path& file);

/// Throws std::runtime_error naming the file if the trajectory that it gave has no poses.
void require_poses(const std::filesystem::path& file, const Trajectory& trajectory);

/// "A to B s": the time that a trajectory covers; "nothing" without poses.
std::string span_text(const Trajectory& trajectory);
std::string span_text(std::int64_t first_utime, std::int64_t last_utime);

}  // namespace planemap
