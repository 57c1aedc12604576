// SPDX-License-Identifier: BSD-3-Clause
#include "map/room_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "map/support.hpp"

namespace planemap::map {

namespace {

constexpr double kLineEnd_m =
    0.4;  // level planes this near to an end of the room are that end: steps, low ceilings
constexpr double kFew = 0.05;         // weight that makes a surplus count half
constexpr double kHanging_m = 0.3;    // what is seen under a plane reaches this much further down,
constexpr double kInFront_m = 0.4;    // and lies further behind it than cupboards on walls are deep,
constexpr double kFarBehind_m = 2.0;  // but not in another room
constexpr double kSpan = 0.6;         // planes that take a larger share of the room's height are its walls

/// Of a room about a direction.
struct Ends {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    double height() const { return high - low; }
    /// 1 at the low end, -1 at the high one.
    double lowness(double at) const { return height() > 0 ? 1 - 2 * (at - low) / height() : 0; }
};

/// Between -1 and 1: what speaks for less what speaks against, less sure of little.
double surplus(double of, double against) {
    return (of - against) / (of + against + kFew);
}

/// Something behind the plane, facing as it does, is seen further down than the plane itself.
bool hangs(const RoomView::Seen& plane, std::span<const RoomView::Seen> planes, const Eigen::Vector3d& u) {
    const Eigen::Vector3d level = plane.normal.cross(u).normalized();
    const double low = plane.along(u).low;
    return std::any_of(planes.begin(), planes.end(), [&](const RoomView::Seen& other) {
        const double facing = other.normal.dot(plane.normal);
        if (facing < 0.9) return false;
        const double behind = other.normal.dot(plane.center - other.center) / facing;
        if (behind < kInFront_m || behind > kFarBehind_m) return false;
        const RoomView::Seen::Range side = plane.along(level), reach = other.along(level);
        return other.along(u).low < low - kHanging_m && reach.low < side.middle() &&
               reach.high > side.middle();
    });
}

/// The outermost vertices of an outline, in twelve directions; the box's corners where there is none.
std::vector<Eigen::Vector3d> corners_of(const MapPlane& plane) {
    constexpr std::size_t kDirections = 12;
    std::array<Eigen::Vector2d, kDirections> directions, outermost;
    for (std::size_t i = 0; i < kDirections; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kDirections;
        directions[i] = {std::cos(angle), std::sin(angle)};
        outermost[i] = directions[i].cwiseSign().cwiseProduct(plane.half_extents.cast<double>());
    }
    std::array<double, kDirections> reach;
    reach.fill(-std::numeric_limits<double>::infinity());
    for_each_packed(
        plane.outline.packed, [](std::size_t) {},
        [&](std::int16_t x, std::int16_t y) {
            const Eigen::Vector2d p = static_cast<double>(plane.outline.unit) * Eigen::Vector2d(x, y);
            for (std::size_t i = 0; i < kDirections; ++i) {
                const double reaches = p.dot(directions[i]);
                if (reaches <= reach[i]) continue;
                reach[i] = reaches;
                outermost[i] = p;
            }
        });
    const Pose world_from_plane = plane.world_from_plane();
    std::vector<Eigen::Vector3d> corners;
    corners.reserve(outermost.size());
    for (const Eigen::Vector2d& p : outermost)
        corners.emplace_back(world_from_plane * Eigen::Vector3d(p.x(), p.y(), 0));
    return corners;
}

}  // namespace

double squareness(const Eigen::Vector3d& normal, const Eigen::Vector3d& u, double sin2) {
    const double cos = normal.dot(u), cos2 = cos * cos;
    if (cos2 < sin2) return cos2 / sin2 - 1;
    return std::max(0.0, 1 - (1 - cos2) / sin2);
}

RoomView::Seen::Range RoomView::Seen::along(const Eigen::Vector3d& direction) const {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Eigen::Vector3d& corner : corners) {
        const double at = corner.dot(direction);
        range.low = std::min(range.low, at);
        range.high = std::max(range.high, at);
    }
    return range;
}

RoomView::RoomView(std::span<const MapPlane> planes) {
    double sum = 0;
    for (const MapPlane& plane : planes) {
        const double length = plane.normal.cast<double>().norm();
        const double weight = trust(plane.keyframes) * std::sqrt(static_cast<double>(plane.area));
        if (!is_plane(plane) || !(weight > 0)) continue;
        planes_.push_back(
            {plane.normal.cast<double>() / length, plane.center.cast<double>(), corners_of(plane), weight});
        sum += weight;
    }
    for (Seen& plane : planes_) plane.weight /= sum;
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const Seen& a, const Seen& b) { return a.weight > b.weight; });
}

double RoomView::square(const Eigen::Vector3d& u, double sin2_tolerance) const {
    double sum = 0;
    for (const Seen& plane : planes_)
        sum += plane.weight * std::abs(squareness(plane.normal, u, sin2_tolerance));
    return sum;
}

RoomView::Reading RoomView::read(const Eigen::Vector3d& u, double sin2_tolerance) const {
    Ends ends;
    std::vector<Seen::Range> heights;
    for (const Seen& plane : planes_) {
        heights.push_back(plane.along(u));
        ends.low = std::min(ends.low, heights.back().low);
        ends.high = std::max(ends.high, heights.back().high);
    }
    Reading reading;
    double up = 0, down = 0, low = 0, high = 0;
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        const Seen& plane = planes_[i];
        const double square = squareness(plane.normal, u, sin2_tolerance);
        if (square == 0) continue;
        const bool is_level = square > 0, faces_up = plane.normal.dot(u) > 0;
        const double height = heights[i].middle();
        const bool is_floor = height<ends.low + kLineEnd_m, is_ceiling = height> ends.high - kLineEnd_m;
        if (is_level && !(faces_up ? is_floor : is_ceiling)) (faces_up ? up : down) += plane.weight;
        if (!is_level && hangs(plane, planes_, u)) reading.hanging += plane.weight;
        if (is_level ? is_floor || is_ceiling : heights[i].length() > kSpan * ends.height()) continue;
        const double lowness = ends.lowness(height);
        (lowness > 0 ? low : high) += plane.weight * std::abs(lowness);
    }
    reading.facing_up = surplus(up, down);
    reading.low = surplus(low, high);
    reading.hanging /= reading.hanging + kFew;
    return reading;
}

}  // namespace planemap::map
