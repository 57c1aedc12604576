// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/plane_raster.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/outline_frame.hpp"

namespace planemap::evaluation {

PlaneRaster::PlaneRaster(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell)
    : cell_m(cell),
      x0(static_cast<int>(std::floor(low.x() / cell_m))),
      y0(static_cast<int>(std::floor(low.y() / cell_m))),
      mask(static_cast<int>(std::ceil(high.x() / cell_m)) - x0,
           static_cast<int>(std::ceil(high.y() / cell_m)) - y0) {}

std::size_t PlaneRaster::count() const {
    return mask.cells.size() -
           static_cast<std::size_t>(std::count(mask.cells.begin(), mask.cells.end(), std::uint8_t{0}));
}

Eigen::Vector2d PlaneRaster::centre() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for_each_cell(*this, [&](int x, int y) { sum += cell_centre(x, y); });
    return sum / static_cast<double>(count());
}

PlaneRaster rasterised(const Outline& outline, double cell_m) {
    if (outline.vertex_count() == 0) return {};
    const Eigen::AlignedBox2d box = bounds(outline);
    PlaneRaster raster(box.min(), box.max(), cell_m);
    Outline in_cells = outline;
    for (Ring& ring : in_cells.rings)
        for (Eigen::Vector2d& v : ring) v = v / cell_m - Eigen::Vector2d(raster.x0, raster.y0);
    fill(in_cells, raster.mask);
    return raster;
}

PlaneRaster united(const PlaneRaster& a, const PlaneRaster& b) {
    if (a.mask.cells.empty()) return b;
    if (b.mask.cells.empty()) return a;
    PlaneRaster both;
    both.cell_m = a.cell_m;
    both.x0 = std::min(a.x0, b.x0);
    both.y0 = std::min(a.y0, b.y0);
    both.mask = Mask(std::max(a.x0 + a.mask.width, b.x0 + b.mask.width) - both.x0,
                     std::max(a.y0 + a.mask.height, b.y0 + b.mask.height) - both.y0);
    for (const PlaneRaster* raster : {&a, &b})
        for_each_cell(*raster, [&](int x, int y) { both.mask.set(x - both.x0, y - both.y0); });
    return both;
}

}  // namespace planemap::evaluation
