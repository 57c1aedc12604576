// SPDX-License-Identifier: BSD-3-Clause
#include "map/intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace planemap::map {

namespace {

struct Interval {
    double low, high;
};
using Intervals = std::vector<Interval>;

/// Smallest distance from a plane to a box.
double distance_to(const Plane& plane, const Box& box) {
    const Eigen::Vector3d in_box = box.frame_from_box.linear().transpose() * plane.normal;
    const double centre = std::abs(plane.signed_distance(box.frame_from_box.translation()));
    return std::max(0.0, centre - in_box.cwiseAbs().dot(box.half_extents));
}

/// Sorted, and joined where less than `bridge` apart.
Intervals joined(Intervals intervals, double bridge) {
    std::sort(intervals.begin(), intervals.end(), [](auto& a, auto& b) { return a.low < b.low; });
    Intervals result;
    for (const Interval& next : intervals) {
        if (!result.empty() && next.low <= result.back().high + bridge) {
            result.back().high = std::max(result.back().high, next.high);
        } else {
            result.push_back(next);
        }
    }
    return result;
}

/// Where along the line the plane is within the gap of it: the outline is cut by lines parallel to it.
Intervals along_line(const PlaneShape& shape, const Line& line, double gap) {
    const Pose box_from_world = shape.box.frame_from_box.inverse(Eigen::Isometry);
    const Eigen::Vector2d origin = (box_from_world * line.origin).head<2>();
    const Eigen::Vector2d along = (box_from_world.linear() * line.direction).head<2>().normalized();
    const Eigen::Vector2d across(-along.y(), along.x());
    constexpr std::size_t kCuts = 7;  // parallel to the line, the middle one on it
    std::array<std::vector<double>, kCuts> crossings;
    for_each_edge(shape.outline, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        const double a = across.dot(from - origin), b = across.dot(to - origin);
        if (std::min(a, b) > gap || std::max(a, b) < -gap) return;
        for (std::size_t cut = 0; cut < kCuts; ++cut) {
            const double height = gap * (2.0 * static_cast<double>(cut) / (kCuts - 1) - 1);
            if ((a > height) == (b > height)) continue;
            const Eigen::Vector2d at = from + (height - a) / (b - a) * (to - from);
            crossings[cut].push_back(along.dot(at - origin));
        }
    });
    Intervals intervals;
    for (std::vector<double>& ends : crossings) {
        std::sort(ends.begin(), ends.end());
        for (std::size_t k = 0; k + 1 < ends.size(); k += 2) intervals.push_back({ends[k], ends[k + 1]});
    }
    return joined(std::move(intervals), gap);
}

Intervals overlap(const Intervals& a, const Intervals& b) {
    Intervals result;
    for (const Interval& x : a) {
        for (const Interval& y : b) {
            const Interval both{std::max(x.low, y.low), std::min(x.high, y.high)};
            if (both.low < both.high) result.push_back(both);
        }
    }
    return result;
}

}  // namespace

double meeting_reach(double rms_a, double rms_b, double sine, const AdjacencyRules& rules) {
    constexpr double kSigmas = 3;
    return std::min(rules.gap_m, rules.slack_m + kSigmas * std::hypot(rms_a, rms_b) / sine);
}

PlaneShape::PlaneShape(const MapPlane& map_plane)
    : id(map_plane.id),
      plane(map_plane.plane()),
      rms(static_cast<double>(map_plane.rms)),
      box(map_plane.box()),
      outline(map_plane.outline.rings()) {
    const Eigen::Matrix3d& axes = box.frame_from_box.linear();
    const Eigen::Vector3d reach = axes.cwiseAbs() * box.half_extents,
                          center = box.frame_from_box.translation();
    low = center - reach;
    high = center + reach;
}

std::vector<IntersectionLine> intersection_lines(const PlaneShape& a, const PlaneShape& b,
                                                 const AdjacencyRules& rules) {
    const PlaneShape &first = a.id < b.id ? a : b, &second = a.id < b.id ? b : a;
    if (!((a.low.array() <= b.high.array() + 2 * rules.gap_m) &&
          (b.low.array() <= a.high.array() + 2 * rules.gap_m))
             .all())
        return {};
    const Plane &plane_a = first.plane, &plane_b = second.plane;
    const Box &box_a = first.box, &box_b = second.box;
    // The common line lies in both planes, so neither box may be further from the other's plane.
    if (distance_to(plane_a, box_b) > rules.gap_m || distance_to(plane_b, box_a) > rules.gap_m) return {};
    const auto line = common_line(plane_a, plane_b, Eigen::Vector3d::Zero(), std::sin(rules.min_angle_rad));
    if (!line) return {};
    const Intervals on_first = along_line(first, *line, rules.gap_m);
    if (on_first.empty()) return {};
    std::vector<IntersectionLine> lines;
    for (const Interval& piece : overlap(on_first, along_line(second, *line, rules.gap_m))) {
        if (piece.high - piece.low < rules.min_length_m) continue;
        const auto at = [&](double along) -> Eigen::Vector3f {
            return (line->origin + along * line->direction).cast<float>();
        };
        lines.push_back({first.id, second.id, at(piece.low), at(piece.high)});
    }
    return lines;
}

std::optional<IntersectionPoint> intersection_point(const PlaneShape& a, const PlaneShape& b,
                                                    const PlaneShape& c, const AdjacencyRules& rules) {
    const auto position = common_point(a.plane, b.plane, c.plane, least_volume(rules.min_angle_rad));
    if (!position) return std::nullopt;
    IntersectionPoint point;
    point.position = position->cast<float>();
    for (const PlaneShape* shape : {&a, &b, &c}) {
        const Eigen::Vector3d p = shape->box.frame_from_box.inverse(Eigen::Isometry) * *position;
        if (distance(shape->outline, p.head<2>()) > rules.gap_m) return std::nullopt;
    }
    point.planes = {a.id, b.id, c.id};
    std::sort(point.planes.begin(), point.planes.end());
    return point;
}

}  // namespace planemap::map
