// SPDX-License-Identifier: BSD-3-Clause
#include "map/sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/bitmap.hpp"

namespace planemap::map {

namespace {

/// Directions further aside than this (76 deg) are not looked at.
constexpr double kMostAside = 4;
constexpr double kLeastDepth_m = 0.05;

constexpr int kColumns = Sight::kWidth + 1, kRows = Sight::kHeight + 1;  // of the cells' corners

}  // namespace

/// Outlines of the regions; sets reach_. Empty for those that lie behind the camera or beside it: they say
/// nothing.
Sight::Directions Sight::directions_of(const std::vector<PlanarRegion>& regions) {
    Directions directions(std::min<std::size_t>(regions.size(), kNone));
    for (std::size_t i = 0; i < directions.size(); ++i) {
        bool in_front = true;
        for (const Ring& ring : regions[i].outline.rings) {
            for (const Eigen::Vector2d& v : ring) {
                const Eigen::Vector3d p = regions[i].box.frame_from_box * Eigen::Vector3d(v.x(), v.y(), 0);
                in_front = in_front && p.z() > kLeastDepth_m;
                reach_ = std::max(reach_, p.norm());
                directions[i].vertices.emplace_back(p.head<2>() / p.z());
            }
            directions[i].ring_ends.push_back(directions[i].vertices.size());
        }
        if (!in_front) directions[i].clear();
    }
    return directions;
}

/// Gives a region the cells that it covers as a whole, where it is nearer than those before.
void Sight::fill(std::uint8_t region, const Plane& plane, const FlatPolygon& directions,
                 std::array<double, kCells>& nearest) {
    Bitmap corners(0, 0, (kColumns + 63) / 64, kRows);
    corners.draw(directions, [&](const Eigen::Vector2d& v) -> Eigen::Vector2d {
        return (v - low_).cwiseProduct(per_cell_);
    });
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            if (!(corners.at(x, y) && corners.at(x + 1, y) && corners.at(x, y + 1) &&
                  corners.at(x + 1, y + 1)))
                continue;
            const Eigen::Vector3d ray(low_.x() + (x + 0.5) / per_cell_.x(),
                                      low_.y() + (y + 0.5) / per_cell_.y(), 1);
            const double depth = -plane.d / plane.normal.dot(ray);
            const std::size_t cell = cell_at(x, y);
            if (!(depth > 0 && depth < nearest[cell])) continue;
            nearest[cell] = depth;
            cells_[cell] = region;
        }
    }
}

Sight::Sight(const std::vector<PlanarRegion>& regions) {
    const Directions directions = directions_of(regions);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
    for (const FlatPolygon& polygon : directions) {
        for (const Eigen::Vector2d& v : polygon.vertices) {
            low = low.cwiseMin(v.cwiseMax(-kMostAside));
            high = high.cwiseMax(v.cwiseMin(kMostAside));
        }
    }
    if (!(low.x() < high.x() && low.y() < high.y())) return;
    low_ = low;
    per_cell_ = Eigen::Vector2d(kWidth, kHeight).cwiseQuotient(high - low);
    std::array<double, kCells> nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < directions.size(); ++i)
        if (!directions[i].vertices.empty())
            fill(static_cast<std::uint8_t>(i), regions[i].plane, directions[i], nearest);
}

}  // namespace planemap::map
