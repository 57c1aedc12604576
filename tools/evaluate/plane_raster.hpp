// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/geometry/outline.hpp"
#include "core/geometry/pose.hpp"

namespace planemap::evaluation {

/// A part of a plane as cells of a lattice over the plane's x and y: cell (x, y) is the square [x, x+1] x
/// [y, y+1] times cell_m. Rasters of one plane and cell size have the same lattice, whatever part of it they
/// hold.
struct PlaneRaster {
    static constexpr double kCell_m = 0.025, kCellArea_m2 = kCell_m * kCell_m;

    double cell_m = kCell_m;
    int x0 = 0, y0 = 0;  ///< lattice cell of the mask's first
    Mask mask;

    PlaneRaster() = default;
    /// Empty, over the given corners (metres).
    PlaneRaster(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell = kCell_m);

    bool at(int x, int y) const { return mask.at(x - x0, y - y0); }
    /// Middle of a lattice cell, metres.
    Eigen::Vector2d cell_centre(int x, int y) const { return cell_m * Eigen::Vector2d(x + 0.5, y + 0.5); }
    std::size_t count() const;
    double area() const { return static_cast<double>(count()) * cell_m * cell_m; }
    /// Middle of the set cells, metres. Precondition: there is one.
    Eigen::Vector2d centre() const;
};

/// The cells whose middle is inside the outline (metres).
PlaneRaster rasterised(const Outline& outline, double cell_m = PlaneRaster::kCell_m);

/// Calls visit(x, y) for each set cell.
template <typename Visit>
void for_each_cell(const PlaneRaster& raster, const Visit& visit) {
    for (int y = 0; y < raster.mask.height; ++y)
        for (int x = 0; x < raster.mask.width; ++x)
            if (raster.mask.at(x, y)) visit(x + raster.x0, y + raster.y0);
}

/// All cells that are set in one of the two. Precondition: their cells have one size.
PlaneRaster united(const PlaneRaster& a, const PlaneRaster& b);

}  // namespace planemap::evaluation
