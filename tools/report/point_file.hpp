// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "core/image.hpp"

namespace planemap {

/// A depth reading as points.ply holds it.
struct PlanePoint {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< world, metres, finite
    Rgb color{};
    int plane = -1;  ///< id of the plane that it lies on; -1: on none
};

/// Reads points.ply (docs/formats.md): binary little-endian PLY whose first element is vertex, with x, y, z
/// as float, red, green, blue as uchar, and plane as int, in any order and with others between them. Points
/// that are not finite are left out. Throws std::runtime_error naming file and reason: it cannot be read, is
/// something else, is cut short, or holds more than 5 million points.
std::vector<PlanePoint> read_points(const std::filesystem::path& file);

}  // namespace planemap
