// SPDX-License-Identifier: BSD-3-Clause
#include "map/bound_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/outline_frame.hpp"
#include "core/geometry/plane_intersection.hpp"

namespace planemap::map {

namespace {

/// So far beyond its outline a raster reaches.
constexpr double kFurthest_m = 5;
/// Of what could be a map, and has thousands of walls, the largest ones count,
constexpr std::size_t kMostPlanes = 1024;
/// with so many cells together.
constexpr double kMostCells = 1 << 27;

/// A rectangle in the x and y of a raster.
struct Range {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;

    void add(const Eigen::Vector2d& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
};

/// The normal of the largest wall, level; else any level direction.
Eigen::Vector3d level_axis(const PlaneMap& map, const Eigen::Vector3d& up) {
    const MapPlane* largest = nullptr;
    for (const MapPlane& plane : map.planes) {
        const bool is_larger = largest == nullptr || plane.area > largest->area;
        if (plane.label == PlaneLabel::kWall && is_larger) largest = &plane;
    }
    if (largest == nullptr) return up.unitOrthogonal();
    const auto along = largest->normal.cast<double>();
    return (along - up.dot(along) * up).normalized();
}

std::vector<const MapPlane*> bounds_of(const PlaneMap& map) {
    std::vector<const MapPlane*> planes;
    for (const MapPlane& plane : map.planes)
        if (is_bound(plane.label) && !plane.outline.empty()) planes.push_back(&plane);
    if (planes.size() > kMostPlanes) {
        std::stable_sort(planes.begin(), planes.end(), [](auto* a, auto* b) { return a->area > b->area; });
        planes.resize(kMostPlanes);
        std::sort(planes.begin(), planes.end(), [](auto* a, auto* b) { return a->id < b->id; });
    }
    return planes;
}

BoundShape shape_of(const MapPlane& plane, const Eigen::Vector3d& up, const Eigen::Vector3d& level) {
    BoundShape shape;
    shape.id = plane.id;
    shape.plane = plane.plane();
    const Eigen::Vector3d x =
        plane.label == PlaneLabel::kWall ? Eigen::Vector3d(up.cross(shape.plane.normal)) : level;
    shape.world_from_raster.linear() = plane_axes(shape.plane.normal, x);
    shape.world_from_raster.translation() = plane.center.cast<double>();
    shape.raster_from_world = shape.world_from_raster.inverse(Eigen::Isometry);
    Range range;
    for (const Eigen::Vector3d& corner : plane.box().face())
        range.add((shape.raster_from_world * corner).head<2>());
    shape.low = range.low;
    shape.high = range.high;
    return shape;
}

/// Where a shape may go on: as far as there are bounds of rooms.
Range range_of(const BoundShape& shape, const std::vector<BoundShape>& shapes) {
    Range range;
    for (const BoundShape& other : shapes) {
        const Pose raster_from_other = shape.raster_from_world * other.world_from_raster;
        const Eigen::Vector2d middle = 0.5 * (other.low + other.high), half = other.high - middle;
        const Eigen::Vector2d at = (raster_from_other * Eigen::Vector3d(middle.x(), middle.y(), 0)).head<2>();
        const Eigen::Vector2d reach = raster_from_other.linear().topLeftCorner<2, 2>().cwiseAbs() * half;
        range.add(at - reach);
        range.add(at + reach);
    }
    const Eigen::Vector2d furthest = Eigen::Vector2d::Constant(kFurthest_m);
    range.low = range.low.cwiseMax(shape.low - furthest);
    range.high = range.high.cwiseMin(shape.high + furthest);
    return range;
}

/// Gives shapes their ranges; returns the cell size.
double set_ranges(std::vector<BoundShape>& shapes, double cell_m) {
    std::vector<Range> ranges;
    double cells = 0;
    for (const BoundShape& shape : shapes) {
        ranges.push_back(range_of(shape, shapes));
        cells += (ranges.back().high - ranges.back().low).prod() / (cell_m * cell_m);
    }
    for (; cells > kMostCells; cells /= 4) cell_m *= 2;
    const double per_block = 1 / (kCellsOfBlock * cell_m);
    const auto block = [&](double metres) { return static_cast<int>(std::floor(metres * per_block)); };
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const auto& [low, high] = ranges[i];
        shapes[i].range = {block(low.x()) - 1, block(low.y()) - 1, block(high.x()) + 1, block(high.y()) + 1};
    }
    return cell_m;
}

/// What of a shape lies before another one, where the two may come together and are not nearly parallel.
void add_before(BoundShape& shape, const std::vector<BoundShape>& shapes, std::size_t other) {
    const Plane plane = shape.raster_from_world * shapes[other].plane;
    const Eigen::Vector2d across = plane.normal.head<2>();
    if (across.norm() < std::sin(kParallel_rad)) return;
    const auto middle = [](const BoundShape& s) -> Eigen::Vector3d {
        const Eigen::Vector2d p = 0.5 * (s.low + s.high);
        return s.world_from_raster * Eigen::Vector3d(p.x(), p.y(), 0);
    };
    const double reach = 0.5 * (shape.high - shape.low).norm() +
                         0.5 * (shapes[other].high - shapes[other].low).norm() + kFurthest_m;
    if ((middle(shape) - middle(shapes[other])).norm() > reach) return;
    shape.before.push_back({other, across.normalized(), plane.d / across.norm()});
}

}  // namespace

Bitmap BoundShape::no_cells() const {
    const int word_from = kCellsOfBlock * range.x0 >> 6, word_to = kCellsOfBlock * (range.x1 + 1) >> 6;
    return {word_from, kCellsOfBlock * range.y0, word_to - word_from + 1, kCellsOfBlock * range.height()};
}

void draw(const Outline& outline, const Pose& raster_from_outline, double cell_m, Bitmap& cells) {
    FlatPolygon polygon;
    polygon.assign(projected(raster_from_outline, outline));
    const Eigen::Vector2d first(64.0 * cells.word0() + 0.5, cells.y0() + 0.5);
    cells.draw(polygon, [&](const Eigen::Vector2d& v) -> Eigen::Vector2d { return v / cell_m - first; });
}

std::vector<BoundShape> bound_shapes(const PlaneMap& map, double& cell_m) {
    std::vector<BoundShape> shapes;
    if (map.up.isZero()) return shapes;
    const Eigen::Vector3d up = map.up.cast<double>().normalized(), level = level_axis(map, up);
    const std::vector<const MapPlane*> planes = bounds_of(map);
    for (const MapPlane* plane : planes) shapes.push_back(shape_of(*plane, up, level));
    cell_m = set_ranges(shapes, cell_m);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        shapes[i].seen = shapes[i].no_cells();
        draw(planes[i]->outline.rings(), shapes[i].raster_from_world * planes[i]->world_from_plane(), cell_m,
             shapes[i].seen);
        for (std::size_t other = 0; other < shapes.size(); ++other)
            if (other != i) add_before(shapes[i], shapes, other);
    }
    return shapes;
}

}  // namespace planemap::map
