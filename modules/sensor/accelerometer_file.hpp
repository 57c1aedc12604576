// SPDX-License-Identifier: BSD-3-Clause
// accelerometer.txt of a folder in the layout of the TUM RGB-D benchmark.
#pragma once

#include <filesystem>
#include <vector>

#include "core/acceleration.hpp"

namespace planemap::sensor {

/// Reads `timestamp ax ay az` lines, m/s2 in the accelerometer's own axes, and turns them into the camera
/// frame. Stamps, blanks and comments are as in read_image_list(); numbers behind the third are skipped; the
/// result is in order of time. Throws std::runtime_error naming file, line and reason.
std::vector<Acceleration> read_accelerometer_file(const std::filesystem::path& file,
                                                  const Eigen::Matrix3d& camera_from_accelerometer);

}  // namespace planemap::sensor
