// SPDX-License-Identifier: BSD-3-Clause
#include "map/free_space.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::map {

namespace {

/// Misses of a cell that is seen past: 2^1.
constexpr int kMissStrength = 1;
/// Viewpoints that a plane is carved by in a rebuild, and more of them for each square metre.
constexpr double kViewpoints = 24, kViewpointsPerM2 = 1;
/// Squared sine of the angle to a plane: flatter rays say nothing, a pixel is a long strip on it.
constexpr double kGrazing2 = 0.04;

/// False for what is behind the camera, beyond its reach, or beside its pyramid.
bool may_see(const Sight& sight, const Eigen::Vector3d& center_camera, double radius) {
    const Eigen::Vector3d& center = center_camera;
    if (center.z() < -radius || center.squaredNorm() > std::pow(radius + sight.reach(), 2)) return false;
    const auto beside = [&](double low, double high, double across) {
        return low * center.z() - across > radius * std::sqrt(1 + low * low) ||
               across - high * center.z() > radius * std::sqrt(1 + high * high);
    };
    const Eigen::Vector2d& low = sight.low();
    const Eigen::Vector2d high = sight.high();
    return !beside(low.x(), high.x(), center.x()) && !beside(low.y(), high.y(), center.y());
}

}  // namespace

Viewpoint::Viewpoint(const StoredKeyframe& seen)
    : keyframe(&seen), camera_from_world(seen.world_from_camera->inverse(Eigen::Isometry)) {
    for (const StoredRegion& region : seen.regions) {
        const Eigen::Quaterniond q = Eigen::Quaterniond(region.camera_from_box.cast<double>()).normalized();
        const Eigen::Vector3d normal = q * Eigen::Vector3d::UnitZ();
        planes.push_back({normal, -normal.dot(region.center.cast<double>())});
    }
}

void FreeSpace::carve(std::vector<PlaneEstimate>& planes, const Viewpoint& viewpoint) const {
    std::vector<EvidenceGrid::Block> uncertain;
    for (PlaneEstimate& plane : planes) {
        const std::optional<Footprint> footprint = footprint_of(plane, viewpoint);
        if (!footprint) continue;
        uncertain.clear();
        plane.grid.uncertain_blocks(footprint->low, footprint->high, uncertain);
        carve(plane, viewpoint, *footprint, uncertain);
    }
}

void FreeSpace::carve(PlaneEstimate& plane, const std::vector<Viewpoint>& viewpoints) const {
    std::vector<EvidenceGrid::Block> uncertain;
    const Eigen::Vector2d everywhere = Eigen::Vector2d::Constant(1e9);
    plane.grid.uncertain_blocks(-everywhere, everywhere, uncertain);
    if (uncertain.empty()) return;
    std::vector<std::pair<const Viewpoint*, Footprint>> near;
    for (const Viewpoint& viewpoint : viewpoints) {
        if (const auto footprint = footprint_of(plane, viewpoint)) near.emplace_back(&viewpoint, *footprint);
    }
    const double area = 4 * plane.box.half_extents.x() * plane.box.half_extents.y();
    const std::size_t stride =
        1 + near.size() / static_cast<std::size_t>(kViewpoints + kViewpointsPerM2 * area);
    for (std::size_t i = 0; i < near.size(); i += stride)
        carve(plane, *near[i].first, near[i].second, uncertain);
}

/// Nothing if it falls beside the plane.
std::optional<FreeSpace::Footprint> FreeSpace::footprint_of(const PlaneEstimate& plane,
                                                            const Viewpoint& viewpoint) {
    const Sight& sight = viewpoint.keyframe->sight;
    const Eigen::Vector3d center = viewpoint.camera_from_world * (0.5 * (plane.low + plane.high));
    if (!may_see(sight, center, 0.5 * (plane.high - plane.low).norm())) return std::nullopt;
    Footprint footprint;
    footprint.camera_from_grid = viewpoint.camera_from_world * plane.grid.world_from_grid();
    const Eigen::Vector3d origin = footprint.camera_from_grid.translation();
    const Eigen::Matrix3d& axes = footprint.camera_from_grid.linear();
    // The pyramid of the image, down to its reach, laid on the plane.
    const double reach = sight.reach();
    const Eigen::Vector2d& low = sight.low();
    const Eigen::Vector2d high = sight.high();
    const Eigen::Vector2d foot(-axes.col(0).dot(origin), -axes.col(1).dot(origin));
    double height_low = -axes.col(2).dot(origin), height_high = height_low;
    footprint.low = footprint.high = foot;
    for (const double u : {low.x(), high.x()}) {
        for (const double v : {low.y(), high.y()}) {
            const Eigen::Vector3d corner = axes.transpose() * (reach * Eigen::Vector3d(u, v, 1) - origin);
            footprint.low = footprint.low.cwiseMin(corner.head<2>());
            footprint.high = footprint.high.cwiseMax(corner.head<2>());
            height_low = std::min(height_low, corner.z());
            height_high = std::max(height_high, corner.z());
        }
    }
    if (height_low > 0 || height_high < 0) return std::nullopt;
    return footprint;
}

void FreeSpace::carve(PlaneEstimate& plane, const Viewpoint& viewpoint, const Footprint& footprint,
                      const std::vector<EvidenceGrid::Block>& uncertain) const {
    const Eigen::Vector3d origin = footprint.camera_from_grid.translation();
    const Eigen::Vector3d x = footprint.camera_from_grid.linear().col(0),
                          y = footprint.camera_from_grid.linear().col(1),
                          normal = footprint.camera_from_grid.linear().col(2);
    int lost = 0;
    const auto first =
        std::lower_bound(uncertain.begin(), uncertain.end(), footprint.low.y(),
                         [](const EvidenceGrid::Block& block, double low) { return block.middle.y() < low; });
    for (auto at = first; at != uncertain.end(); ++at) {
        const EvidenceGrid::Block& block = *at;
        if (block.middle.x() < footprint.low.x() || block.middle.x() > footprint.high.x()) continue;
        if (block.middle.y() > footprint.high.y()) break;  // they come row after row
        const Eigen::Vector3d p = origin + block.middle.x() * x + block.middle.y() * y;
        const std::uint8_t region = viewpoint.keyframe->sight.region_at(p);
        if (region == Sight::kNone) continue;
        const double facing = normal.dot(p);
        if (facing * facing < kGrazing2 * p.squaredNorm()) continue;
        const Plane& beyond = viewpoint.planes[region];
        // Depth of that region along the ray through the point.
        const double depth = -beyond.d / beyond.normal.dot(p) * p.z();
        if (depth > p.z() + margin_m_ + 2 * viewpoint.keyframe->noise.sigma(depth))
            lost += plane.grid.add_misses(block, kMissStrength);
    }
    plane.changed_cells += lost;
    plane.changed = plane.changed || lost > 0;
}

}  // namespace planemap::map
