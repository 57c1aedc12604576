// SPDX-License-Identifier: BSD-3-Clause
#include "map/merging.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/segment.hpp"

namespace planemap::map {

namespace {

/// A convex polygon of at most eight corners: a rectangle, or what another one leaves of it.
struct Corners {
    std::array<Eigen::Vector2d, 8> p;
    std::size_t count = 0;

    void push_back(const Eigen::Vector2d& corner) {
        if (count < p.size()) p[count++] = corner;
    }
    double area() const {
        double twice = 0;
        for (std::size_t i = 0, j = count - 1; i < count; j = i++) twice += cross(p[j], p[i]);
        return 0.5 * twice;
    }
};

/// A box's middle face seen along a direction: columns of axes are the view's x, y and direction.
Corners seen_along(const Eigen::Matrix3d& axes, const Eigen::Vector3d& origin, const Box& box) {
    Corners corners;
    for (const Eigen::Vector3d& corner : box.face())
        corners.push_back((axes.transpose() * (corner - origin)).head<2>());
    if (corners.area() < 0) std::reverse(corners.p.begin(), corners.p.begin() + 4);
    return corners;
}

/// Part of a rectangle inside another one that is counter-clockwise (Sutherland-Hodgman).
Corners clipped(Corners corners, const Corners& by) {
    for (std::size_t i = 0, j = by.count - 1; i < by.count && corners.count > 0; j = i++) {
        const Eigen::Vector2d inward(by.p[j].y() - by.p[i].y(), by.p[i].x() - by.p[j].x());
        Corners kept;
        for (std::size_t k = 0, l = corners.count - 1; k < corners.count; l = k++) {
            const Eigen::Vector2d &from = corners.p[l], &to = corners.p[k];
            const double before = inward.dot(from - by.p[j]), here = inward.dot(to - by.p[j]);
            if ((before < 0) != (here < 0)) kept.push_back(from + before / (before - here) * (to - from));
            if (here >= 0) kept.push_back(to);
        }
        corners = kept;
    }
    return corners;
}

struct NearestPoints {
    double gap = std::numeric_limits<double>::infinity();
    Eigen::Vector2d midpoint = Eigen::Vector2d::Zero();
};

/// Nearest points between the corners of one polygon and the edges of the other, both ways; exact for convex
/// ones that do not overlap.
NearestPoints nearest_points(const Corners& a, const Corners& b) {
    NearestPoints best;
    for (const auto& [corners, edges] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        for (std::size_t k = 0; k < corners->count; ++k) {
            const Eigen::Vector2d& p = corners->p[k];
            for (std::size_t i = 0, j = edges->count - 1; i < edges->count; j = i++) {
                const Eigen::Vector2d q = nearest_on_segment(p, edges->p[j], edges->p[i]);
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

/// Root mean square over a convex polygon of the height between two planes; the square of a linear function
/// is integrated exactly over the triangles of a fan.
double rms_over(const Corners& corners, const Height& a, const Height& b) {
    double integral = 0, total = 0;
    const auto f = [&](const Eigen::Vector2d& p) { return a(p) - b(p); };
    for (std::size_t i = 1; i + 1 < corners.count; ++i) {
        const Eigen::Vector2d &p = corners.p[0], &q = corners.p[i], &r = corners.p[i + 1];
        const double x = f(p), y = f(q), z = f(r);
        const double triangle = 0.5 * ((q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x()));
        integral += triangle * (x * x + y * y + z * z + x * y + y * z + z * x) / 6;
        total += triangle;
    }
    return std::sqrt(std::max(0.0, integral / total));
}

}  // namespace

double RegionRelation::score(const MergeRules& rules) const {
    return angle_rad / std::max(rules.angle_rad, 1e-9) + distance_m / std::max(rules.distance_m, 1e-9) +
           gap_m / std::max(rules.gap_m, 1e-9);
}

RegionRelation relate(const Plane& plane_a, const Box& box_a, const Plane& plane_b, const Box& box_b) {
    const Eigen::Vector3d both = plane_a.normal + plane_b.normal;
    const Eigen::Vector3d view = both.norm() > 1e-6 ? both.normalized().eval() : plane_a.normal;
    const Eigen::Matrix3d axes = plane_axes(view, box_a.frame_from_box.linear().col(0));
    const Eigen::Vector3d origin = box_a.frame_from_box.translation();
    const Corners a = seen_along(axes, origin, box_a), b = seen_along(axes, origin, box_b);
    const Height height_a(axes, origin, plane_a), height_b(axes, origin, plane_b);

    RegionRelation relation;
    relation.angle_rad = angle_between(plane_a.normal, plane_b.normal);
    const Corners overlap = clipped(b, a);
    if (overlap.count >= 3 && overlap.area() > 1e-9) {
        relation.distance_m = rms_over(overlap, height_a, height_b);
    } else {
        const NearestPoints nearest = nearest_points(a, b);
        relation.gap_m = nearest.gap;
        relation.distance_m = std::abs(height_a(nearest.midpoint) - height_b(nearest.midpoint));
    }
    return relation;
}

std::optional<RegionRelation> same_plane(const Plane& plane_a, const Box& box_a, const Plane& plane_b,
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

    const RegionRelation relation = relate(plane_a, box_a, plane_b, box_b);
    const bool same = relation.distance_m <= rules.distance_m && relation.gap_m <= rules.gap_m;
    return same ? std::optional(relation) : std::nullopt;
}

}  // namespace planemap::map
