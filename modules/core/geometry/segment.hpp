// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace planemap {

/// Twice the area of the triangle from the origin to a and b: positive if b lies to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// The point of the segment from a to b that is nearest to p.
inline Eigen::Vector2d nearest_on_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                          const Eigen::Vector2d& b) {
    const Eigen::Vector2d ab = b - a;
    const double length2 = ab.squaredNorm();
    const double s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    return a + s * ab;
}

/// Distance from a point to the segment from a to b.
inline double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                  const Eigen::Vector2d& b) {
    return (p - nearest_on_segment(p, a, b)).norm();
}

/// True when the segment crosses the line of that y. An end on the line counts as
/// below it, so that of two segments that meet there and go on, one crosses.
inline bool crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y) {
    return (a.y() > y) != (b.y() > y);
}

/// Where a segment that crosses the line of that y does so.
inline double x_of_crossing(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y) {
    return (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()) + a.x();
}

/// True when the segment passes to the right of p at p's y: p is inside a polygon of which an odd number of
/// edges do (even-odd rule).
inline bool passes_right_of(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return crosses(a, b, p.y()) && p.x() < x_of_crossing(a, b, p.y());
}

}  // namespace planemap
