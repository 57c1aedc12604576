// SPDX-License-Identifier: BSD-3-Clause
#include "map/opposite.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/bitmap.hpp"
#include "core/geometry/box.hpp"
#include "core/geometry/outline_frame.hpp"

namespace planemap::map {

namespace {

constexpr double kCells = 10000;       // of the common part of the outlines' bounds
constexpr double kLeastCell_m = 1e-3;  // what outlines are stored to

/// A plane's outline in the x and y of a view.
Outline seen(const MapPlane& plane, const Pose& view_from_world) {
    return projected(view_from_world * plane.world_from_plane(), plane.outline.rings());
}

/// The cells of an outline in a raster of cells from `low` on.
Bitmap drawn(const Outline& outline, const Eigen::Vector2d& low, double cell_m, int width, int height) {
    FlatPolygon polygon;
    polygon.assign(outline);
    Bitmap cells(0, 0, (width + 63) / 64, height);
    const Eigen::Vector2d first_centre(0.5, 0.5);
    cells.draw(polygon, [&](const Eigen::Vector2d& v) -> Eigen::Vector2d {
        return (v - low) / cell_m - first_centre;
    });
    return cells;
}

}  // namespace

Eigen::Vector3d Opposite::middle() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& cell : cells) sum += cell;
    return in_world(sum / static_cast<double>(cells.size()));
}

Opposite opposite_of(const MapPlane& a, const MapPlane& b, const Eigen::Vector3d& along) {
    Opposite opposite;
    opposite.world_from_view.linear() = plane_axes(along, a.world_from_plane().linear().col(0));
    opposite.world_from_view.translation() = a.center.cast<double>();
    const Pose view_from_world = opposite.world_from_view.inverse(Eigen::Isometry);
    const Outline seen_a = seen(a, view_from_world), seen_b = seen(b, view_from_world);
    const Eigen::AlignedBox2d common = bounds(seen_a).intersection(bounds(seen_b));
    if (common.isEmpty() || !common.min().allFinite() || !common.max().allFinite()) return opposite;
    const Eigen::Vector2d size = common.sizes();
    opposite.cell_m =
        std::max({kLeastCell_m, std::sqrt(size.x() * size.y() / kCells), size.maxCoeff() / kCells});
    const auto count = [&](double length) { return static_cast<int>(std::ceil(length / opposite.cell_m)); };
    const int width = count(size.x()), height = count(size.y());
    Bitmap both = drawn(seen_a, common.min(), opposite.cell_m, width, height);
    both &= drawn(seen_b, common.min(), opposite.cell_m, width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (both.at(x, y))
                opposite.cells.push_back(common.min() + opposite.cell_m * Eigen::Vector2d(x + 0.5, y + 0.5));
        }
    }
    return opposite;
}

}  // namespace planemap::map
