// SPDX-License-Identifier: BSD-3-Clause
#include "run/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace planemap {

namespace {

using Cell = Eigen::Vector3i;

struct CellHash {
    std::size_t operator()(const Cell& c) const {
        std::size_t hash = 0;
        for (const int i : {c.x(), c.y(), c.z()})
            hash = (hash ^ static_cast<std::size_t>(i)) * std::size_t{0x9e3779b97f4a7c15};
        return hash ^ hash >> 29;
    }
};

/// Points by the cube of one leaf size that they are in.
class Neighbourhood {
  public:
    Neighbourhood(const std::vector<Eigen::Vector3d>& points, double size) : size_(size) {
        for (const Eigen::Vector3d& p : points)
            if (p.allFinite()) cells_[cell(p)].push_back(p);
    }
    /// True when a point lies within one leaf size of p.
    bool has_near(const Eigen::Vector3d& p) const {
        const Cell middle = cell(p);
        for (int i = 0; i < 27; ++i) {
            const auto found = cells_.find(middle + Cell(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
            if (found == cells_.end()) continue;
            for (const Eigen::Vector3d& q : found->second)
                if ((p - q).norm() <= size_) return true;
        }
        return false;
    }

  private:
    Cell cell(const Eigen::Vector3d& p) const { return (p / size_).array().floor().cast<int>(); }

    double size_;
    std::unordered_map<Cell, std::vector<Eigen::Vector3d>, CellHash> cells_;
};

bool is_explained(const std::vector<PlanarRegion>& planes, const Eigen::Vector3d& p, double reach) {
    return std::any_of(planes.begin(), planes.end(), [&](const PlanarRegion& region) {
        // Cheap tests before the outline: the plane, then a circle around the box.
        if (std::abs(region.plane.signed_distance(p)) > reach) return false;
        const double apart = (p - region.box.frame_from_box.translation()).norm();
        return apart <= region.box.half_extents.norm() + 2 * reach && distance(region, p) <= reach;
    });
}

}  // namespace

Coverage coverage_of(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves, double leaf_m) {
    Coverage coverage;
    std::vector<PlanarRegion> planes;
    for (const MapPlane& plane : map.planes) planes.push_back(plane.region());
    if (!leaves.empty()) {
        const auto explained = std::count_if(leaves.begin(), leaves.end(), [&](const Eigen::Vector3d& leaf) {
            return is_explained(planes, leaf, leaf_m);
        });
        coverage.leaves_explained = static_cast<double>(explained) / static_cast<double>(leaves.size());
    }
    const Neighbourhood neighbourhood(leaves, leaf_m);
    const double step = leaf_m / 2;
    std::size_t samples = 0, supported = 0;
    for (const PlanarRegion& plane : planes) {
        const Box& box = plane.box;
        // One cell of margin, because a simplified outline may reach out of the box a little.
        const int columns = static_cast<int>(std::ceil(2 * box.half_extents.x() / step)) + 4;
        const int rows = static_cast<int>(std::ceil(2 * box.half_extents.y() / step)) + 4;
        for (int i = 0; i < rows * columns; ++i) {
            const Eigen::Vector2d p =
                step * Eigen::Vector2d(i % columns - 0.5 * (columns - 1), i / columns - 0.5 * (rows - 1));
            if (!contains(plane.outline, p)) continue;
            ++samples;
            supported += neighbourhood.has_near(box.frame_from_box * Eigen::Vector3d(p.x(), p.y(), 0));
        }
    }
    if (samples > 0) coverage.area_supported = static_cast<double>(supported) / static_cast<double>(samples);
    return coverage;
}

}  // namespace planemap
