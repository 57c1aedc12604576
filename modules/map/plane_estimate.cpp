// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace planemap::map {

namespace {

/// An estimate whose plane turned further than this against its frames gets new ones.
constexpr double kMaxTilt = 0.9994;  // cosine of 2 deg

Moments scaled(const Moments& moments, double factor) {
    return {factor * moments.count, factor * moments.sum, factor * moments.scatter};
}

const std::array<Eigen::Vector2d, Extent::kDirections>& directions() {
    static const auto table = [] {
        std::array<Eigen::Vector2d, Extent::kDirections> d;
        for (std::size_t i = 0; i < d.size(); ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / Extent::kDirections;
            d[i] = {std::cos(angle), std::sin(angle)};
        }
        return d;
    }();
    return table;
}

}  // namespace

double misfit2(const PlacedRegion& region, const Plane& plane) {
    const Eigen::Vector3d offset = plane.normal - region.plane.normal;
    const Eigen::Vector3d mean = region.moments.mean();
    const double tilt = offset.dot(region.moments.covariance() * offset);
    return std::max(0.0, tilt) +
           std::pow(plane.signed_distance(mean) - region.plane.signed_distance(mean), 2);
}

Extent::Extent() {
    reach_.fill(-1e300);
}

void Extent::add(const Eigen::Vector2d& p) {
    const auto& d = directions();
    for (std::size_t i = 0; i < kDirections; ++i)
        reach_[i] = std::max(reach_[i], d[i].x() * p.x() + d[i].y() * p.y());
}

std::array<Eigen::Vector2d, Extent::kDirections> Extent::corners() const {
    // Each half-plane touches the points, so neighbouring ones meet in the corners of their intersection.
    static const double sine = std::sin(2 * std::numbers::pi / kDirections);
    const auto& d = directions();
    std::array<Eigen::Vector2d, kDirections> corners;
    for (std::size_t i = 0; i < kDirections; ++i) {
        const std::size_t j = (i + 1) % kDirections;
        corners[i] = Eigen::Vector2d(reach_[i] * d[j].y() - reach_[j] * d[i].y(),
                                     reach_[j] * d[i].x() - reach_[i] * d[j].x()) /
                     sine;
    }
    return corners;
}

PlaneEstimate::PlaneEstimate(const PlacedRegion& region, const FlatPolygon& outline_box,
                             const Reliability& reliability)
    : plane(region.plane), world_from_extent(region.box.frame_from_box) {
    long_axis_ = region.box.frame_from_box.linear().col(0);
    add(region, outline_box, reliability);
    refit();
}

PlaneEstimate::PlaneEstimate(const MapPlane& map_plane, double cell_m)
    : id(map_plane.id),
      plane(map_plane.plane()),
      world_from_extent(map_plane.world_from_plane()),
      grid(map_plane.world_from_plane(), cell_m),
      keyframes(map_plane.keyframes) {
    // Moments of points spread evenly over the outline, with the plane's spread about it.
    const Outline outline = map_plane.outline.rings();
    const Eigen::Vector2d half = map_plane.half_extents.cast<double>().cwiseMax(0.01);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    covariance.diagonal() << half.x() * half.x() / 3, half.y() * half.y() / 3,
        std::min(std::pow(static_cast<double>(map_plane.rms), 2), 0.01 * std::pow(half.minCoeff(), 2));
    const Eigen::Matrix3d r = world_from_extent.linear();
    const Eigen::Vector3d mean = world_from_extent.translation();
    moments.count = map_plane.inliers;
    moments.sum = moments.count * mean;
    moments.scatter = moments.count * (r * covariance * r.transpose() + mean * mean.transpose());
    weighted = moments;
    facing = moments.count * plane.normal;
    FlatPolygon polygon;
    polygon.assign(outline);
    for (const Eigen::Vector2d& v : polygon.vertices) extent.add(v);
    for (const double x : {-half.x(), half.x()})
        for (const double y : {-half.y(), half.y()}) extent.add({x, y});
    for (const int strength : {2, 2, 2}) grid.add(polygon, strength, EvidenceCells::kMaxOdds);
    refit();
}

PlaneEstimate PlaneEstimate::emptied() const {
    PlaneEstimate left;
    left.id = id;
    left.plane = plane;
    left.world_from_extent = world_from_extent;
    left.long_axis_ = long_axis_;
    left.fitted_weight = std::numeric_limits<double>::infinity();
    return left;
}

void PlaneEstimate::add(const PlacedRegion& region, const FlatPolygon& outline_extent,
                        const Reliability& reliability) {
    moments += region.moments;
    const double agreement = 1 + misfit2(region, plane) / std::pow(2 * reliability.sigma_m, 2);
    const Moments w = scaled(region.moments, reliability.weight / (agreement * agreement));
    weighted += w;
    facing += w.count * region.plane.normal;
    for (const Eigen::Vector2d& v : outline_extent.vertices) extent.add(v);
    changed = true;
    if (weighted.count > 1.1 * fitted_weight) {
        refit();
    } else {
        rebox();
    }
}

void PlaneEstimate::absorb(const PlaneEstimate& other) {
    moments += other.moments;
    weighted += other.weighted;
    facing += other.facing;
    keyframes += other.keyframes;
    last_keyframe = std::max(last_keyframe, other.last_keyframe);
    const Pose extent_from_other = world_from_extent.inverse(Eigen::Isometry) * other.world_from_extent;
    for (const Eigen::Vector2d& v : other.extent.corners())
        extent.add((extent_from_other * Eigen::Vector3d(v.x(), v.y(), 0)).head<2>());
    if (other.grid.memory_bytes() > grid.memory_bytes()) {
        EvidenceGrid larger = other.grid;
        larger.add(grid);
        grid = std::move(larger);
    } else {
        grid.add(other.grid);
    }
    changed_cells = kAllCells;
    refit();
}

void PlaneEstimate::refit() {
    const PlaneFit fit = fit_plane(weighted);
    if (fit.valid) {
        plane = fit.plane;
        long_axis_ = fit.axes.col(2);
    }
    if (plane.normal.dot(facing) < 0) plane = plane.flipped();
    fitted_weight = weighted.count;
    changed = true;
    if (world_from_extent.linear().col(2).dot(plane.normal) < kMaxTilt) {
        Pose level = Pose::Identity();
        level.linear() = plane_axes(plane.normal, world_from_extent.linear().col(0));
        level.translation() = plane.project(world_from_extent.translation());
        const Pose level_from_extent = level.inverse(Eigen::Isometry) * world_from_extent;
        Extent turned;
        for (const Eigen::Vector2d& v : extent.corners())
            turned.add((level_from_extent * Eigen::Vector3d(v.x(), v.y(), 0)).head<2>());
        extent = turned;
        world_from_extent = level;
    }
    if (!grid.empty() && grid.world_from_grid().linear().col(2).dot(plane.normal) < kMaxTilt) {
        Pose level = Pose::Identity();
        level.linear() = plane_axes(plane.normal, long_axis_);
        level.translation() = plane.project(grid.world_from_grid().translation());
        EvidenceGrid turned(level, grid.cell_m());
        turned.add(grid);
        grid = std::move(turned);
        changed_cells = kAllCells;
    }
    rebox();
}

void PlaneEstimate::count_keyframe(int id, int with_handed_on) {
    if (last_keyframe != id) keyframes += with_handed_on;
    last_keyframe = id;
}

void PlaneEstimate::rebox() {
    const Eigen::Matrix3d axes = plane_axes(plane.normal, long_axis_);
    const Eigen::Matrix<double, 2, 3> flat = axes.leftCols<2>().transpose();
    const Eigen::Matrix2d turn = flat * world_from_extent.linear().leftCols<2>();
    const Eigen::Vector2d origin = flat * world_from_extent.translation();
    Eigen::Vector2d from = Eigen::Vector2d::Constant(1e300), to = -from;
    for (const Eigen::Vector2d& v : extent.corners()) {
        const Eigen::Vector2d p = origin + turn * v;
        from = from.cwiseMin(p);
        to = to.cwiseMax(p);
    }
    const Eigen::Vector2d middle = 0.5 * (from + to), half = 0.5 * (to - from);
    box.frame_from_box.linear() = axes;
    box.frame_from_box.translation() = axes * Eigen::Vector3d(middle.x(), middle.y(), -plane.d);
    box.half_extents << half, 0;
    const Eigen::Vector3d reach = axes.col(0).cwiseAbs() * half.x() + axes.col(1).cwiseAbs() * half.y();
    low = box.frame_from_box.translation() - reach;
    high = box.frame_from_box.translation() + reach;
}

}  // namespace planemap::map
