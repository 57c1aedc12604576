// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "core/cloud_point.hpp"

namespace planemap {

/// Reads points.ply (docs/formats.md): binary little-endian PLY whose first element is vertex, with x, y, z
/// as float, red, green, blue as uchar, and plane as int, in any order and with others between them. Points
/// that are not finite are left out. Throws std::runtime_error naming file and reason: it cannot be read, is
/// something else, is cut short, or holds more than 5 million points.
std::vector<CloudPoint> read_points(const std::filesystem::path& file);

}  // namespace planemap
