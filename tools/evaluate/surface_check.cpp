// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/surface_check.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/geometry/outline_frame.hpp"
#include "evaluate/readings.hpp"

namespace planemap::evaluation {

namespace {
constexpr std::size_t kLargest = 10;
constexpr double kReach_m = 0.03;
}  // namespace

SurfaceChecker::SurfaceChecker(const PlaneMap& map) {
    for (const MapPlane& plane : map.planes) {
        Entry entry{plane.id,
                    plane.plane(),
                    plane.world_from_plane().inverse(Eigen::Isometry),
                    plane.outline.rings(),
                    {},
                    static_cast<double>(plane.area),
                    {}};
        entry.bounds = bounds(entry.outline);
        entries_.push_back(std::move(entry));
    }
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.area > b.area; });
    if (entries_.size() > kLargest) entries_.resize(kLargest);
}

void SurfaceChecker::add(const DepthImage& depth, const CameraInfo& camera, const Pose& world_from_color) {
    const Pose world_from_depth = world_from_color * camera.color_from_depth;
    for_each_reading(depth, camera, [&](int u, int v, double z) {
        const Eigen::Vector3d p_world = world_from_depth * camera.depth.unproject(u, v, z);
        for (Entry& entry : entries_) {
            if (std::abs(entry.plane.signed_distance(p_world)) > kReach_m) continue;
            const Eigen::Vector3d p = entry.plane_from_world * p_world;
            if (!entry.bounds.contains(p.head<2>().eval())) continue;
            if (contains(entry.outline, p.head<2>())) entry.moments.add(p);
        }
    });
}

std::vector<SurfaceCheck> SurfaceChecker::checks() const {
    std::vector<SurfaceCheck> checks;
    for (const Entry& entry : entries_) {
        const PlaneFit fit = fit_plane(entry.moments, Eigen::Vector3d::UnitZ());
        if (!fit.valid) continue;
        // The box's middle is the origin of the plane's frame.
        checks.push_back({entry.id, entry.area, entry.moments.count,
                          degrees(angle_between(fit.plane.normal, Eigen::Vector3d::UnitZ())),
                          std::abs(fit.plane.d)});
    }
    return checks;
}

}  // namespace planemap::evaluation
