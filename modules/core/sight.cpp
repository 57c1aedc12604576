// SPDX-License-Identifier: BSD-3-Clause
#include "core/sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/bitmap.hpp"

namespace planemap {

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

/// While cells are given to regions.
struct Sight::Filling {
    std::array<double, kCells> nearest;        ///< depth of what a cell holds so far
    std::array<std::uint8_t, kCells> covered;  ///< corners of it, a bit each

    Filling() {
        nearest.fill(std::numeric_limits<double>::infinity());
        covered.fill(0);
    }
};

/// Gives a region the cells that it covers in part, where it is nearer than those before.
void Sight::fill(std::uint8_t region, const Plane& plane, const FlatPolygon& directions, Filling& filling) {
    constexpr std::uint8_t kAll = 15;
    Bitmap corners(0, 0, (kColumns + 63) / 64, kRows);
    corners.draw(directions, [&](const Eigen::Vector2d& v) -> Eigen::Vector2d {
        return (v - low_).cwiseProduct(per_cell_);
    });
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int covered = corners.at(x, y) | corners.at(x + 1, y) << 1 | corners.at(x, y + 1) << 2 |
                                corners.at(x + 1, y + 1) << 3;
            if (covered == 0) continue;
            const double depth = -plane.d / plane.normal.dot(direction_of(x, y));
            const std::size_t cell = cell_at(x, y);
            if (!(depth > 0)) continue;
            filling.covered[cell] |= static_cast<std::uint8_t>(covered);
            if (!(depth < filling.nearest[cell])) continue;
            filling.nearest[cell] = depth;
            cells_[cell] = region;
            whole_[cell] = covered == kAll;
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
    Filling filling;
    for (std::size_t i = 0; i < directions.size(); ++i)
        if (!directions[i].vertices.empty())
            fill(static_cast<std::uint8_t>(i), regions[i].plane, directions[i], filling);
    for (std::size_t cell = 0; cell < kCells; ++cell)
        if (filling.covered[cell] != 15) cells_[cell] = kNone;
}

bool Sight::may_hold(const Eigen::Vector3d& center, double radius) const {
    if (center.z() < -radius) return false;
    const auto beside = [&](double low, double high, double across) {
        return low * center.z() - across > radius * std::sqrt(1 + low * low) ||
               across - high * center.z() > radius * std::sqrt(1 + high * high);
    };
    return !beside(low_.x(), high().x(), center.x()) && !beside(low_.y(), high().y(), center.y());
}

int count_seen_past(const SeenRegions& one, const SeenRegions& other, const Pose& other_from_one,
                    const PastRules& rules, const DepthNoise& noise) {
    int past = 0;
    for (int y = 0; y < Sight::kHeight; ++y) {
        for (int x = 0; x < Sight::kWidth; ++x) {
            const std::uint8_t region = one.sight.region_in(x, y);
            if (region == Sight::kNone) continue;
            const Plane& plane = one.planes[region];
            const Eigen::Vector3d ray = one.sight.direction_of(x, y);
            const Eigen::Vector3d p = other_from_one * (-plane.d / plane.normal.dot(ray) * ray);
            const std::optional<double> depth = other.depth_behind(p);
            if (!depth) continue;
            past += rules.is_past(p, other_from_one.linear() * plane.normal, *depth, noise).value_or(false);
        }
    }
    return past;
}

bool has_changed(const SeenRegions& one, const SeenRegions& other, const Pose& other_from_one,
                 const DepthNoise& noise) {
    constexpr int kLeastCells = 3;
    const PastRules rules;
    return count_seen_past(one, other, other_from_one, rules, noise) >= kLeastCells ||
           count_seen_past(other, one, other_from_one.inverse(Eigen::Isometry), rules, noise) >= kLeastCells;
}

}  // namespace planemap
