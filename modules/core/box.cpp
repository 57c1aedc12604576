// SPDX-License-Identifier: BSD-3-Clause
#include "core/box.hpp"

#include <algorithm>
#include <cmath>

namespace planemap {

namespace {

/// Nearest point of a box to p, both in the box's owner frame.
Eigen::Vector3d nearest_point(const Box& box, const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = box.frame_from_box.inverse(Eigen::Isometry) * p;
    return box.frame_from_box * q.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
}

}  // namespace

std::array<Eigen::Vector3d, 8> Box::corners() const {
    std::array<Eigen::Vector3d, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        const Eigen::Vector3d sign((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
        corners[i] = frame_from_box * half_extents.cwiseProduct(sign);
    }
    return corners;
}

std::array<Eigen::Vector3d, 4> Box::face() const {
    const double x = half_extents.x(), y = half_extents.y();
    return {frame_from_box * Eigen::Vector3d(-x, -y, 0), frame_from_box * Eigen::Vector3d(x, -y, 0),
            frame_from_box * Eigen::Vector3d(x, y, 0), frame_from_box * Eigen::Vector3d(-x, y, 0)};
}

Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal, const Eigen::Vector3d& long_axis) {
    Eigen::Vector3d x = long_axis - normal.dot(long_axis) * normal;
    if (!(x.norm() > 1e-6)) x = normal.unitOrthogonal();
    x.normalize();
    Eigen::Matrix3d axes;
    axes << x, normal.cross(x), normal;
    return axes;
}

Eigen::Matrix3d principal_axes(const Plane& plane, const Moments& moments) {
    return plane_axes(plane.normal, fit_plane(moments).axes.col(2));
}

Box operator*(const Pose& b_from_a, const Box& box_a) {
    return {b_from_a * box_a.frame_from_box, box_a.half_extents};
}

double distance(const Box& a, const Box& b) {
    // Alternating projection between two convex sets converges to the closest pair.
    Eigen::Vector3d p = a.frame_from_box.translation();
    double gap = 0;
    for (int i = 0; i < 64; ++i) {
        const Eigen::Vector3d q = nearest_point(b, p);
        const Eigen::Vector3d next = nearest_point(a, q);
        const double next_gap = (next - q).norm();
        const bool settled = i > 0 && gap - next_gap < 1e-6;
        gap = next_gap;
        p = next;
        if (gap < 1e-9 || settled) break;
    }
    return gap < 1e-6 ? 0.0 : gap;
}

}  // namespace planemap
