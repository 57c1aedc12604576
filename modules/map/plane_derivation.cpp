// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_derivation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/outline_frame.hpp"

namespace planemap::map {

namespace {

/// An outline is traced again when so many cells came or went, as many as the smallest hole has (0.01 m2).
constexpr int kCellsOfNote = 16;
/// A plane whose points moved less keeps its outline and its intersections.
constexpr double kMoveOfNote_m = 0.001;

/// Root mean square distance of a set of points to any plane.
double rms_to(const Plane& plane, const Moments& moments) {
    const double spread = plane.normal.dot(moments.covariance() * plane.normal);
    return std::sqrt(std::max(0.0, spread) + std::pow(plane.signed_distance(moments.mean()), 2));
}

/// A wall and all that stands at it meet at some twenty lines. What could be a map and has hundreds of planes
/// that all cross would take hours: of such a plane the longest lines count.
constexpr std::size_t kMostLines = 64;

/// The meetings in the x and y of the grid from which projected() leads to the axes.
std::vector<MeetingLine> lines_in_grid(const std::vector<Meeting>& meetings, const Pose& axes_from_world,
                                       const Pose& axes_from_grid) {
    const Eigen::Matrix2d grid_from_axes = axes_from_grid.linear().topLeftCorner<2, 2>().inverse();
    const Eigen::Vector2d origin = axes_from_grid.translation().head<2>();
    const auto in_grid = [&](const Eigen::Vector3f& p_world) -> Eigen::Vector2d {
        return grid_from_axes * ((axes_from_world * p_world.cast<double>()).head<2>() - origin);
    };
    std::vector<MeetingLine> lines;
    lines.reserve(meetings.size());
    for (const Meeting& meeting : meetings)
        lines.push_back({in_grid(meeting.line.from), in_grid(meeting.line.to), meeting.reach_m});
    if (lines.size() <= kMostLines) return lines;
    std::stable_sort(lines.begin(), lines.end(), [](const MeetingLine& a, const MeetingLine& b) {
        return (a.to - a.from).squaredNorm() > (b.to - b.from).squaredNorm();
    });
    lines.resize(kMostLines);
    return lines;
}

/// Gives a region the box along the axes of a frame, around the outline, and the outline in it.
void set_outline(PlanarRegion& region, const Pose& world_from_axes, Outline outline_axes) {
    const Eigen::AlignedBox2d box = bounds(outline_axes);
    const Eigen::Vector2d middle = 0.5 * (box.min() + box.max()), half = 0.5 * (box.max() - box.min());
    for (Ring& ring : outline_axes.rings) {
        for (Eigen::Vector2d& v : ring) v -= middle;
    }
    region.box.frame_from_box = world_from_axes;
    region.box.frame_from_box.translation() = world_from_axes * Eigen::Vector3d(middle.x(), middle.y(), 0);
    region.box.half_extents << half, 0;
    region.outline = std::move(outline_axes);
}

/// The estimate with an outline in the grid; nothing if it is too small.
std::optional<MapPlane> plane_of(const PlaneEstimate& estimate, const Outline& outline_grid,
                                 const DerivationRules& rules) {
    if (outline_grid.empty()) return std::nullopt;
    PlanarRegion region;
    region.plane = estimate.plane;
    region.moments = estimate.moments;
    region.rms = rms_to(estimate.plane, estimate.moments);
    const Pose& world_from_axes = estimate.box.frame_from_box;  // the principal ones
    set_outline(
        region, world_from_axes,
        projected(world_from_axes.inverse(Eigen::Isometry) * estimate.grid.world_from_grid(), outline_grid));
    const MapPlane derived(estimate.id, region, static_cast<std::size_t>(estimate.keyframes));
    const double least = estimate.keyframes < 2 ? rules.min_single_m2 : 0;
    if (!(derived.area > 0) || static_cast<double>(derived.area) < std::max(least, rules.min_area_m2))
        return std::nullopt;
    return derived;
}

}  // namespace

std::optional<MapPlane> derived_plane(const PlaneEstimate& estimate, const DerivationRules& rules) {
    if (estimate.keyframes < rules.min_keyframes) return std::nullopt;
    return plane_of(estimate, exact_outline_of(estimate.grid, rules.outline), rules);
}

std::optional<MapPlane> ended_plane(const PlaneEstimate& estimate, const DerivationRules& rules,
                                    const std::vector<Meeting>& meetings) {
    const Pose axes_from_world = estimate.box.frame_from_box.inverse(Eigen::Isometry);
    const std::vector<MeetingLine> lines =
        lines_in_grid(meetings, axes_from_world, axes_from_world * estimate.grid.world_from_grid());
    return plane_of(estimate, outline_of(estimate.grid, rules.outline, lines), rules);
}

bool keeps_outline(const PlaneEstimate& estimate, const MapPlane& derived, const Plane& as_drawn) {
    if (estimate.changed_cells >= kCellsOfNote) return false;
    const double turn = as_drawn.normal.cross(estimate.plane.normal).norm();
    const Eigen::Vector3d center = as_drawn.project(derived.center.cast<double>());
    const double shift = std::abs(estimate.plane.signed_distance(center));
    return shift + turn * static_cast<double>(derived.half_extents.norm()) < kMoveOfNote_m;
}

void move_to_estimate(MapPlane& derived, const PlaneEstimate& estimate) {
    derived.move_to(estimate.plane);
    derived.keyframes = static_cast<std::int16_t>(std::min(estimate.keyframes, 32767));
    derived.inliers = static_cast<float>(estimate.moments.count);
    derived.rms = static_cast<float>(rms_to(estimate.plane, estimate.moments));
}

}  // namespace planemap::map
