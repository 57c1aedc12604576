// SPDX-License-Identifier: BSD-3-Clause
#include "core/region.hpp"

#include <algorithm>
#include <cmath>

namespace planemap {

PlanarRegion operator*(const Pose& b_from_a, const PlanarRegion& region_a) {
    PlanarRegion b = region_a;
    b.plane = b_from_a * region_a.plane;
    b.moments = b_from_a * region_a.moments;
    b.box = b_from_a * region_a.box;
    return b;
}

bool is_valid(const PlanarRegion& region) {
    if (!is_valid(region.plane) || !is_valid(region.box.frame_from_box)) return false;
    if (!(region.moments.count >= 3) || !std::isfinite(region.moments.count)) return false;
    if (!region.moments.sum.allFinite() || !region.moments.scatter.allFinite()) return false;
    if (!region.box.half_extents.allFinite() || region.box.half_extents.minCoeff() < 0) return false;
    if (!std::isfinite(region.rms) || region.rms < 0) return false;
    return std::all_of(region.outline.rings.begin(), region.outline.rings.end(), [](const Ring& ring) {
        return ring.size() >= 3 &&
               std::all_of(ring.begin(), ring.end(), [](const auto& v) { return v.allFinite(); });
    });
}

double distance(const PlanarRegion& region, const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = region.box.frame_from_box.inverse(Eigen::Isometry) * p;
    const Eigen::Vector2d flat = q.head<2>();
    const double within = region.outline.empty()
                              ? (flat.cwiseAbs() - region.box.half_extents.head<2>()).cwiseMax(0.0).norm()
                              : distance(region.outline, flat);
    return std::hypot(within, region.plane.signed_distance(p));
}

}  // namespace planemap
