// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planemap {

namespace {

/// Distance from a point to a box, both in the box's owner frame.
double distance_to_box(const Box& box, const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = box.frame_from_box.inverse(Eigen::Isometry) * p;
    return (q.cwiseAbs() - box.half_extents).cwiseMax(0.0).norm();
}

/// An edge of a box: centre -+ half.
struct BoxEdge {
    Eigen::Vector3d centre, half;
};

std::array<BoxEdge, 12> edges(const Box& box) {
    const Eigen::Matrix3d spans = box.frame_from_box.linear() * box.half_extents.asDiagonal();
    std::array<BoxEdge, 12> all;
    for (unsigned i = 0; i < 12; ++i) {
        const int along = static_cast<int>(i / 4), second = (along + 1) % 3, third = (along + 2) % 3;
        const Eigen::Vector3d offset =
            ((i & 1) ? 1.0 : -1.0) * spans.col(second) + ((i & 2) ? 1.0 : -1.0) * spans.col(third);
        all[i] = {box.frame_from_box.translation() + offset, spans.col(along)};
    }
    return all;
}

/// Squared distance between two edges where their lines are nearest, or infinity if that is not within both:
/// an end is then nearest, and the corners' distances cover it.
double squared_distance_between(const BoxEdge& a, const BoxEdge& b) {
    const Eigen::Vector3d between = b.centre - a.centre;
    const double aa = a.half.squaredNorm(), bb = b.half.squaredNorm(), ab = a.half.dot(b.half);
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-14 * aa * bb)) return std::numeric_limits<double>::infinity();
    const double da = a.half.dot(between), db = b.half.dot(between);
    const double s = (da * bb - db * ab) / determinant, t = (da * ab - db * aa) / determinant;
    if (std::abs(s) > 1 || std::abs(t) > 1) return std::numeric_limits<double>::infinity();
    return (between + t * b.half - s * a.half).squaredNorm();
}

/// True when a plane separates the boxes: one along a face of either or along an edge of each.
bool separated(const Box& a, const Box& b) {
    const Eigen::Matrix3d axes_a = a.frame_from_box.linear(), axes_b = b.frame_from_box.linear();
    const Eigen::Vector3d between = b.frame_from_box.translation() - a.frame_from_box.translation();
    const auto separates = [&](const Eigen::Vector3d& axis) {
        return std::abs(between.dot(axis)) > (axes_a.transpose() * axis).cwiseAbs().dot(a.half_extents) +
                                                 (axes_b.transpose() * axis).cwiseAbs().dot(b.half_extents);
    };
    for (int i = 0; i < 3; ++i) {
        if (separates(axes_a.col(i)) || separates(axes_b.col(i))) return true;
        for (int j = 0; j < 3; ++j) {
            const Eigen::Vector3d axis = axes_a.col(i).cross(axes_b.col(j));
            if (axis.squaredNorm() > 1e-12 && separates(axis)) return true;
        }
    }
    return false;
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
    if (!separated(a, b)) return 0;
    // The nearest points of two convex polyhedra that do not meet: a corner and a face, or two edges.
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& corner : a.corners()) nearest = std::min(nearest, distance_to_box(b, corner));
    for (const auto& corner : b.corners()) nearest = std::min(nearest, distance_to_box(a, corner));
    double nearest_squared = nearest * nearest;
    const auto edges_a = edges(a), edges_b = edges(b);
    for (const BoxEdge& edge_a : edges_a) {
        for (const BoxEdge& edge_b : edges_b)
            nearest_squared = std::min(nearest_squared, squared_distance_between(edge_a, edge_b));
    }
    return std::sqrt(nearest_squared);
}

}  // namespace planemap
