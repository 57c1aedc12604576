// SPDX-License-Identifier: BSD-3-Clause
#include "map/standing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/angle.hpp"
#include "map/support.hpp"

namespace planemap::map {

namespace {

constexpr double kBehind_m = 0.15;   // one wall that poses put in two places stands that far before itself
constexpr double kDeepest_m = 1.2;   // furniture; what is seen further behind is another room's
constexpr double kOver_m = 0.1;      // by which what is behind reaches higher
constexpr double kSideBySide = 0.3;  // share of the plane's width at which both are
constexpr double kWeakest = 0.1;     // support of what is behind, as a share of the plane's
constexpr double kAtTop_m = 0.1;     // the level plane's height to the upper edge,
constexpr double kBeforeFront_m = 0.2, kBehindFront_m = 0.15;  // and its front edge to the plane
constexpr double kTallestWithTop_m = 2.0;
constexpr double kMostTurn_deg = 8;

/// By how much a plane may be turned by the bend of its readings: their distance to it at half its shorter
/// side.
double turn_by_noise(const MapPlane& plane) {
    const double half = static_cast<double>(plane.half_extents.minCoeff());
    const double turn = std::atan2(static_cast<double>(plane.rms), half);
    return std::isfinite(turn) ? std::clamp(turn, 0.0, radians(kMostTurn_deg)) : 0;
}

/// The outline's lowest and highest vertex, without unpacking it.
void find_extent(const MapOutline& outline, const Eigen::Vector3d& slope, Standing& s) {
    const Eigen::Vector2d per_step = static_cast<double>(outline.unit) * slope.head<2>();
    s.low = outline.empty() ? s.height : std::numeric_limits<double>::infinity();
    s.high = outline.empty() ? s.height : -s.low;
    for_each_packed(
        outline.packed, [](std::size_t) {},
        [&](std::int16_t x, std::int16_t y) {
            const double height = s.height + per_step.x() * x + per_step.y() * y;
            s.low = std::min(s.low, height);
            s.high = std::max(s.high, height);
        });
}

/// Share of an upright plane's width beside which another plane lies.
double side_by_side(const Standing& upright, const Standing& other, const Eigen::Vector3d& up) {
    const Eigen::Vector3d along = upright.normal.cross(up).normalized();
    const double at = along.dot(other.center - upright.center), half = upright.half_length(along);
    const double reach = other.half_length(along);
    const double shared = std::min(half, at + reach) - std::max(-half, at - reach);
    return half > 0 ? shared / (2 * half) : 0;
}

/// Distance from the centre of an upright plane straight back to a plane that faces much as it does.
double depth_behind(const Standing& upright, const Standing& other) {
    return other.normal.dot(upright.center - other.center) / other.normal.dot(upright.normal);
}

}  // namespace

double Standing::support_between(double from, double to) const {
    const double inside = std::min(high, to) - std::max(low, from);
    return inside >= 0 ? support * std::min(1.0, (inside + 1e-3) / (high - low + 1e-3)) : 0;
}

std::vector<Standing> standing_planes(PlaneMap& map, const Eigen::Vector3d& up, double tolerance_rad) {
    std::vector<Standing> planes;
    planes.reserve(map.planes.size());
    for (MapPlane& plane : map.planes) {
        if (!is_plane(plane)) continue;
        const Pose world_from_plane = plane.world_from_plane();
        const Eigen::Vector3d slope = world_from_plane.linear().transpose() * up;
        Standing s;
        s.plane = &plane;
        s.area = static_cast<double>(plane.area);
        s.support = supported_area(plane);
        s.center = world_from_plane.translation();
        s.normal = world_from_plane.linear().col(2);
        s.half_x = static_cast<double>(plane.half_extents.x()) * world_from_plane.linear().col(0);
        s.half_y = static_cast<double>(plane.half_extents.y()) * world_from_plane.linear().col(1);
        s.height = up.dot(s.center);
        const double tolerance = tolerance_rad + turn_by_noise(plane);
        if (std::abs(slope.z()) > std::cos(tolerance)) {
            s.lie = slope.z() > 0 ? Lie::kFacesUp : Lie::kFacesDown;
        } else if (std::abs(slope.z()) < std::sin(tolerance)) {
            s.lie = Lie::kUpright;
        }
        find_extent(plane.outline, slope, s);
        planes.push_back(s);
    }
    std::stable_sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.support > b.support; });
    return planes;
}

bool is_seen_over(const Standing& upright, const std::vector<Standing>& planes, const Eigen::Vector3d& up) {
    return std::any_of(planes.begin(), planes.end(), [&](const Standing& other) {
        if (other.lie != Lie::kUpright || other.normal.dot(upright.normal) < 0.9) return false;
        const double behind = depth_behind(upright, other);
        return behind > kBehind_m && behind < kDeepest_m && other.high > upright.high + kOver_m &&
               other.support > kWeakest * upright.support && side_by_side(upright, other, up) > kSideBySide;
    });
}

bool has_top(const Standing& upright, const std::vector<Standing>& planes, const Eigen::Vector3d& up) {
    if (upright.high - upright.low > kTallestWithTop_m) return false;
    return std::any_of(planes.begin(), planes.end(), [&](const Standing& other) {
        if (other.lie != Lie::kFacesUp || std::abs(other.height - upright.high) > kAtTop_m) return false;
        const double front =
            upright.normal.dot(upright.center - other.center) - other.half_length(upright.normal);
        return front > -kBeforeFront_m && front < kBehindFront_m &&
               side_by_side(upright, other, up) > kSideBySide;
    });
}

}  // namespace planemap::map
