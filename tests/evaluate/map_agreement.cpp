// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map_agreement.hpp"

#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/geometry/outline_frame.hpp"
#include "evaluate/plane_raster.hpp"

namespace planemap::test {

namespace {

constexpr double kCell_m = 0.01, kFarthest_m = 0.1, kSteepest_deg = 10;

struct Shared {
    std::size_t cells_a = 0, cells_b = 0, common = 0;
    double distance_m = 0;  ///< mean over the common cells

    double iou() const {
        return static_cast<double>(common) / static_cast<double>(cells_a + cells_b - common);
    }
};

/// The outlines of both planes on a raster in a's plane.
Shared share(const MapPlane& a, const MapPlane& b) {
    using evaluation::PlaneRaster;
    const Pose a_from_b = a.world_from_plane().inverse(Eigen::Isometry) * b.world_from_plane();
    const PlaneRaster cells_a = evaluation::rasterised(a.outline.rings(), kCell_m);
    const PlaneRaster cells_b = evaluation::rasterised(projected(a_from_b, b.outline.rings()), kCell_m);
    const Plane b_in_a = a_from_b * Plane{Eigen::Vector3d::UnitZ(), 0};
    Shared shared{cells_a.count(), cells_b.count()};
    for_each_cell(cells_a, [&](int x, int y) {
        if (!cells_b.at(x, y)) return;
        ++shared.common;
        const Eigen::Vector2d p = cells_a.cell_centre(x, y);
        shared.distance_m += std::abs(b_in_a.signed_distance({p.x(), p.y(), 0}));
    });
    if (shared.common > 0) shared.distance_m /= static_cast<double>(shared.common);
    return shared;
}

}  // namespace

Agreement best_agreement(const MapPlane& plane, const PlaneMap& other) {
    Agreement best;
    for (const MapPlane& there : other.planes) {
        const double angle = degrees(angle_between(plane.plane().normal, there.plane().normal));
        if (angle > kSteepest_deg) continue;
        const Shared shared = share(plane, there);
        if (shared.common == 0 || shared.distance_m > kFarthest_m || shared.iou() <= best.iou) continue;
        best = {there.id, shared.distance_m, angle, shared.iou()};
    }
    return best;
}

}  // namespace planemap::test
