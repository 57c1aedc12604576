// SPDX-License-Identifier: BSD-3-Clause
#include "map/merging.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/outline.hpp"

namespace planemap {

namespace {

/// A box's middle face seen along a direction: columns of axes are the view's x, y and direction.
Ring seen_along(const Eigen::Matrix3d& axes, const Eigen::Vector3d& origin, const Box& box) {
    Ring ring;
    for (const Eigen::Vector3d& corner : box.face())
        ring.push_back((axes.transpose() * (corner - origin)).head<2>());
    if (signed_area(ring) < 0) std::reverse(ring.begin(), ring.end());
    return ring;
}

/// Part of a convex ring inside another counter-clockwise convex ring (Sutherland-Hodgman).
Ring clipped(Ring ring, const Ring& by) {
    for (std::size_t i = 0, j = by.size() - 1; i < by.size() && !ring.empty(); j = i++) {
        const Eigen::Vector2d inward(by[j].y() - by[i].y(), by[i].x() - by[j].x());
        Ring kept;
        for (std::size_t k = 0, l = ring.size() - 1; k < ring.size(); l = k++) {
            const double before = inward.dot(ring[l] - by[j]), here = inward.dot(ring[k] - by[j]);
            if ((before < 0) != (here < 0))
                kept.push_back(ring[l] + before / (before - here) * (ring[k] - ring[l]));
            if (here >= 0) kept.push_back(ring[k]);
        }
        ring = std::move(kept);
    }
    return ring;
}

struct NearestPoints {
    double gap = std::numeric_limits<double>::infinity();
    Eigen::Vector2d midpoint = Eigen::Vector2d::Zero();
};

/// Nearest points between the corners of one ring and the edges of the other, both ways; exact for convex
/// rings that do not overlap.
NearestPoints nearest_points(const Ring& a, const Ring& b) {
    NearestPoints best;
    for (const auto& [corners, edges] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        for (const Eigen::Vector2d& p : *corners) {
            for (std::size_t i = 0, j = edges->size() - 1; i < edges->size(); j = i++) {
                const Eigen::Vector2d from = (*edges)[j], along = (*edges)[i] - from;
                const double length2 = along.squaredNorm();
                const double s = length2 > 0 ? std::clamp((p - from).dot(along) / length2, 0.0, 1.0) : 0.0;
                const Eigen::Vector2d q = from + s * along;
                if ((p - q).norm() < best.gap) best = {(p - q).norm(), 0.5 * (p + q)};
            }
        }
    }
    return best;
}

/// The plane as a height over the view's plane: height(p) = offset + slope . p.
struct Height {
    Eigen::Vector2d slope;
    double offset;

    Height(const Eigen::Matrix3d& axes, const Eigen::Vector3d& origin, const Plane& plane) {
        const Eigen::Vector3d n = axes.transpose() * plane.normal;
        slope = -n.head<2>() / n.z();
        offset = -plane.signed_distance(origin) / n.z();
    }
    double operator()(const Eigen::Vector2d& p) const { return offset + slope.dot(p); }
};

/// Root mean square over a convex ring of the height between two planes; the square of a linear function is
/// integrated exactly over the triangles of a fan.
double rms_over(const Ring& ring, const Height& a, const Height& b) {
    double integral = 0, total = 0;
    const auto f = [&](const Eigen::Vector2d& p) { return a(p) - b(p); };
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        const double x = f(ring[0]), y = f(ring[i]), z = f(ring[i + 1]);
        const double triangle = signed_area(Ring{ring[0], ring[i], ring[i + 1]});
        integral += triangle * (x * x + y * y + z * z + x * y + y * z + z * x) / 6;
        total += triangle;
    }
    return std::sqrt(std::max(0.0, integral / total));
}

}  // namespace

PlaneRelation relate(const Plane& plane_a, const Box& box_a, const Plane& plane_b, const Box& box_b) {
    const Eigen::Vector3d both = plane_a.normal + plane_b.normal;
    const Eigen::Vector3d view = both.norm() > 1e-6 ? both.normalized().eval() : plane_a.normal;
    const Eigen::Matrix3d axes = plane_axes(view, box_a.frame_from_box.linear().col(0));
    const Eigen::Vector3d origin = box_a.frame_from_box.translation();
    const Ring a = seen_along(axes, origin, box_a), b = seen_along(axes, origin, box_b);
    const Height height_a(axes, origin, plane_a), height_b(axes, origin, plane_b);

    PlaneRelation relation;
    relation.angle_rad = angle_between(plane_a.normal, plane_b.normal);
    const Ring overlap = clipped(b, a);
    if (overlap.size() >= 3 && signed_area(overlap) > 1e-9) {
        relation.distance_m = rms_over(overlap, height_a, height_b);
    } else {
        const NearestPoints nearest = nearest_points(a, b);
        relation.gap_m = nearest.gap;
        relation.distance_m = std::abs(height_a(nearest.midpoint) - height_b(nearest.midpoint));
    }
    return relation;
}

std::optional<PlaneRelation> same_plane(const Plane& plane_a, const Box& box_a, const Plane& plane_b,
                                        const Box& box_b, const MergeRules& rules) {
    // The cheap tests first: most pairs fail one of them.
    if (plane_a.normal.dot(plane_b.normal) < std::cos(rules.angle_rad)) return std::nullopt;
    const double reach =
        box_a.half_extents.norm() + box_b.half_extents.norm() + rules.gap_m + rules.distance_m;
    const Eigen::Vector3d apart = box_a.frame_from_box.translation() - box_b.frame_from_box.translation();
    if (apart.squaredNorm() > reach * reach) return std::nullopt;
    // Wherever the distance is measured, it is within the gap of box b.
    const double reach_b = box_b.half_extents.head<2>().norm() + rules.gap_m;
    const double rise = reach_b * plane_a.normal.cross(plane_b.normal).norm();
    const double centre = std::abs(plane_a.signed_distance(box_b.frame_from_box.translation()));
    if (centre > rise + rules.distance_m) return std::nullopt;

    const PlaneRelation relation = relate(plane_a, box_a, plane_b, box_b);
    const bool same = relation.distance_m <= rules.distance_m && relation.gap_m <= rules.gap_m;
    return same ? std::optional(relation) : std::nullopt;
}

}  // namespace planemap
