// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/geometry/outline.hpp"

namespace planemap::bench_map {

/// A part of a plane as cells of a lattice over the plane's x and y: cell (x, y) is the square [x, x+1] x
/// [y, y+1] times kCell_m. Rasters of one plane have the same lattice, whatever part of it they hold.
struct PlaneRaster {
    static constexpr double kCell_m = 0.025;

    int x0 = 0, y0 = 0;  ///< lattice cell of the mask's first
    Mask mask;

    PlaneRaster() = default;
    /// Empty, over the given corners (metres) and `margin` cells more on each side.
    PlaneRaster(const Eigen::Vector2d& low, const Eigen::Vector2d& high, int margin);

    bool at(int x, int y) const { return mask.at(x - x0, y - y0); }
    std::size_t count() const;
    double area() const { return static_cast<double>(count()) * kCell_m * kCell_m; }
    /// Middle of the set cells, metres. Precondition: there is one.
    Eigen::Vector2d centre() const;
};

/// Middle of a lattice cell, metres.
inline Eigen::Vector2d cell_centre(int x, int y) {
    return PlaneRaster::kCell_m * Eigen::Vector2d(x + 0.5, y + 0.5);
}

/// The cells whose middle is inside the outline (metres).
PlaneRaster rasterised(const Outline& outline);

/// Calls visit(x, y) for each set cell.
template <typename Visit>
void for_each_cell(const PlaneRaster& raster, const Visit& visit) {
    for (int y = 0; y < raster.mask.height; ++y)
        for (int x = 0; x < raster.mask.width; ++x)
            if (raster.mask.at(x, y)) visit(x + raster.x0, y + raster.y0);
}

/// All cells that are set in one of the two.
PlaneRaster united(const PlaneRaster& a, const PlaneRaster& b);

}  // namespace planemap::bench_map
