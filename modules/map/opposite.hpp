// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/plane_map.hpp"

namespace planemap::map {

/// What of two outlines lies opposite, seen along a direction: cells of a raster whose middles are in both.
struct Opposite {
    Pose world_from_view = Pose::Identity();  ///< z along the direction; cells lie in its x and y
    double cell_m = 0;                        ///< side of a cell
    std::vector<Eigen::Vector2d> cells;       ///< middles, row after row; at most some 10,000

    double area() const { return static_cast<double>(cells.size()) * cell_m * cell_m; }
    Eigen::Vector3d in_world(const Eigen::Vector2d& cell) const {
        return world_from_view * Eigen::Vector3d(cell.x(), cell.y(), 0);
    }
    /// Mean of the cells, world. Precondition: there are some.
    Eigen::Vector3d middle() const;
};

/// Preconditions: `along` is a unit vector and no plane lies along it. Nothing is opposite of an outline that
/// is not finite.
Opposite opposite_of(const MapPlane& a, const MapPlane& b, const Eigen::Vector3d& along);

}  // namespace planemap::map
