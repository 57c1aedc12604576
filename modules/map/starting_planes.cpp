// SPDX-License-Identifier: BSD-3-Clause
#include "map/starting_planes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/outline_frame.hpp"

namespace planemap::map {

namespace {

/// Cells of all rasters together, a byte each: 80,000 m2 at 2.5 cm.
constexpr double kMaxCells = 1 << 27;
constexpr int kMaxId = 1 << 30;

/// Of the rectangle around a plane's outline and its middle, which its raster covers.
double raster_area(const MapPlane& plane) {
    const Eigen::AlignedBox2d covered =
        bounds(plane.outline.rings()).extend(Eigen::Vector2d(Eigen::Vector2d::Zero()));
    return (covered.max() - covered.min()).prod();
}

/// The most cells that a raster may have, so that all of them keep within kMaxCells: small planes take what
/// they need, and the large ones share the rest evenly. Infinity if there is room for all.
double largest_share(std::vector<double> areas, double cell_area) {
    std::sort(areas.begin(), areas.end());
    double left = kMaxCells;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const double share = left / static_cast<double>(areas.size() - i), cells = areas[i] / cell_area;
        if (cells > share) return share;
        left -= cells;
    }
    return std::numeric_limits<double>::infinity();
}

bool is_in_range(const MapPlane& plane, double max_extent_m) {
    double reach = static_cast<double>(plane.half_extents.norm());
    for (const std::int16_t steps : plane.outline.packed)
        reach = std::max(reach, std::abs(static_cast<double>(plane.outline.unit) * steps));
    return plane.id >= 0 && plane.id < kMaxId && reach <= max_extent_m &&
           static_cast<double>(plane.center.norm()) <= kMaxCoordinate_m;
}

}  // namespace

StartingPlanes starting_planes(const PlaneMap& map, double max_extent_m, double cell_m) {
    StartingPlanes start;
    std::vector<const MapPlane*> usable;
    std::vector<double> areas;
    for (const MapPlane& plane : map.planes) {
        if (!is_in_range(plane, max_extent_m)) {
            ++start.refused;
            continue;
        }
        usable.push_back(&plane);
        areas.push_back(raster_area(plane));
    }
    const double most_cells = largest_share(areas, std::pow(cell_m, 2));
    for (std::size_t i = 0; i < usable.size(); ++i) {
        const double cell = std::max(cell_m, std::sqrt(areas[i] / most_cells));
        start.coarsened += cell > cell_m;
        start.planes.emplace_back(*usable[i], cell);
    }
    return start;
}

}  // namespace planemap::map
