// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "core/geometry/moments.hpp"

namespace planemap {

/// An oriented box around a planar region: the bounding box B of paper section 2.1. The axes of its frame are
/// the principal axes of the region's points (x: longest, y: second, z: the plane's normal); the origin is
/// the centre.
struct Box {
    Pose frame_from_box = Pose::Identity();                  ///< frame: camera or world, as the owner says
    Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  ///< metres, along the box's x, y, z

    /// The eight corners, in the owner's frame.
    std::array<Eigen::Vector3d, 8> corners() const;
    /// The four corners of the middle face (z = 0 in the box), counter-clockwise about the normal.
    std::array<Eigen::Vector3d, 4> face() const;
};

/// Right-handed axes for a plane: x along `long_axis` made perpendicular to the normal, z the normal.
/// A long_axis parallel to the normal (or zero) is replaced by an arbitrary perpendicular one.
Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal, const Eigen::Vector3d& long_axis);

/// The axes of a region: z the plane's normal, x the longest principal axis of its points (paper
/// section 2.1).
Eigen::Matrix3d principal_axes(const Plane& plane, const Moments& moments);

/// The same box in frame b.
Box operator*(const Pose& b_from_a, const Box& box_a);

/// Smallest box with the given axes (columns, a rotation) that holds all the points; an empty input gives a
/// box of zero extents at the origin.
template <typename Points>
Box bound(const Eigen::Matrix3d& axes, const Points& points) {
    Box box;
    box.frame_from_box.linear() = axes;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = Eigen::Vector3d::Constant(-1e300);
    bool any = false;
    for (const auto& p : points) {
        const Eigen::Vector3d q = axes.transpose() * p;
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
        any = true;
    }
    if (!any) return box;
    box.frame_from_box.translation() = axes * (0.5 * (low + high));
    box.half_extents = 0.5 * (high - low);
    return box;
}

/// Gap between two boxes, metres: 0 when they overlap or touch (paper section 2.3, "within 50 cm").
/// Exact: a separating-axis test, then the nearest of all corners to the other box and of all pairs of edges.
double distance(const Box& a, const Box& b);

}  // namespace planemap
