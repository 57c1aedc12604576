// SPDX-License-Identifier: BSD-3-Clause
// The planes that bound a map's rooms, on rasters along the rooms' axes.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "core/plane_map.hpp"
#include "map/hidden_blocks.hpp"

namespace planemap::map {

/// Cells of a block of HiddenBlocks, along a side.
inline constexpr int kCellsOfBlock = 4;

/// True for what bounds a room: floors, ceilings and walls.
inline bool is_bound(PlaneLabel label) {
    return label == PlaneLabel::kFloor || label == PlaneLabel::kCeiling || label == PlaneLabel::kWall;
}

/// The half of a plane that lies before another one, in the x and y of its raster.
struct HalfPlane {
    std::size_t other;       ///< index of the other shape
    Eigen::Vector2d normal;  ///< unit
    double offset;

    double inside(const Eigen::Vector2d& p) const { return normal.dot(p) + offset; }
};

/// A floor, a ceiling or a wall.
struct BoundShape {
    int id = -1;
    Plane plane;
    Pose world_from_raster, raster_from_world;  ///< z: the normal; y: up, of a wall
    Eigen::Vector2d low, high;                  ///< of the box of the outline, in the raster's x and y
    BlockRange range;                           ///< of the raster, which may reach further
    Bitmap seen;                                ///< the outline
    std::vector<HalfPlane> before;              ///< others that it may meet

    /// An empty bitmap of all cells.
    Bitmap no_cells() const;
};

/// All of a map; of thousands, the largest ones. `cell_m` is made larger where the rasters would take too
/// much. None where up is not known.
std::vector<BoundShape> bound_shapes(const PlaneMap& map, double& cell_m);

/// Sets the cells of an outline, which lies in the plane of a raster, in an empty bitmap of it.
void draw(const Outline& outline, const Pose& raster_from_outline, double cell_m, Bitmap& cells);

}  // namespace planemap::map
