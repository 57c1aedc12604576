// SPDX-License-Identifier: BSD-3-Clause
#include "run/explained_leaves.hpp"

#include <cmath>

#include "core/geometry/outline_index.hpp"

namespace planemap {

namespace {

/// A plane's outline, to be asked for many points.
class Shape {
  public:
    explicit Shape(const MapPlane& plane)
        : plane_from_world_(plane.world_from_plane().inverse(Eigen::Isometry)),
          outline_(plane.outline.rings()) {
        for (const Ring& ring : plane.outline.rings().rings)
            for (const Eigen::Vector2d& v : ring) reach_ = std::max(reach_, v.norm());
    }
    bool is_within(const Eigen::Vector3d& p_world, double within_m) const {
        const Eigen::Vector3d p = plane_from_world_ * p_world;
        if (std::abs(p.z()) > within_m || p.head<2>().norm() > reach_ + within_m) return false;
        return std::hypot(outline_.distance_within(p.head<2>(), within_m), p.z()) <= within_m;
    }

  private:
    Pose plane_from_world_;
    OutlineIndex outline_;
    double reach_ = 0;
};

}  // namespace

std::vector<Eigen::Vector3d> explained_leaves(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves,
                                              double within_m) {
    std::vector<Shape> shapes;
    for (const MapPlane& plane : map.planes)
        if (!plane.outline.empty()) shapes.emplace_back(plane);
    std::vector<Eigen::Vector3d> explained;
    for (const Eigen::Vector3d& leaf : leaves) {
        for (const Shape& shape : shapes) {
            if (!shape.is_within(leaf, within_m)) continue;
            explained.push_back(leaf);
            break;
        }
    }
    return explained;
}

}  // namespace planemap
