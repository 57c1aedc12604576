// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/inferred_judge.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "evaluate/statistics.hpp"

namespace planemap::evaluation {

namespace {

/// Whether a point of a plane lies on a true one.
bool is_on(const TruePlane& plane, const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) {
    if (plane.plane.normal.dot(normal) < std::cos(radians(kMaxAngle_deg))) return false;
    const Eigen::Vector3d p = plane.world_from_plane.inverse(Eigen::Isometry) * p_world;
    if (std::abs(p.z()) > kMaxDistance_m) return false;
    const double cell = plane.material.cell_m;
    return plane.material.at(static_cast<int>(std::floor(p.x() / cell)),
                             static_cast<int>(std::floor(p.y() / cell)));
}

}  // namespace

std::optional<double> InferredJudgement::right() const {
    return share(right_m2, area_m2);
}

InferredJudgement judge_inferred(const std::vector<TruePlane>& truth, const PlaneMap& map,
                                 const Pose& truth_from_map) {
    InferredJudgement judgement;
    for (const InferredRings& rings : map.inferred) {
        const MapPlane* plane = map.find(rings.plane);
        if (plane == nullptr) continue;
        const Pose truth_from_plane = truth_from_map * plane->world_from_plane();
        const PlaneRaster cells = rasterised(rings.outline.rings());
        const double cell_m2 = cells.cell_m * cells.cell_m;
        for_each_cell(cells, [&](int x, int y) {
            const Eigen::Vector2d middle = cells.cell_centre(x, y);
            const Eigen::Vector3d p = truth_from_plane * Eigen::Vector3d(middle.x(), middle.y(), 0);
            judgement.area_m2 += cell_m2;
            if (std::any_of(truth.begin(), truth.end(), [&](const TruePlane& is) {
                    return is_on(is, p, truth_from_plane.linear().col(2));
                }))
                judgement.right_m2 += cell_m2;
        });
    }
    return judgement;
}

}  // namespace planemap::evaluation
