// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/geometry/pose.hpp"

namespace planemap {

/// The plane n.p + d = 0 with unit normal n (paper section 2.1).
/// In a camera frame the normal points towards the sensor, so d > 0.
struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    double d = 0;  ///< metres

    /// Signed distance of a point to the plane, metres; positive on the side the normal points to.
    double signed_distance(const Eigen::Vector3d& p) const { return normal.dot(p) + d; }
    /// The nearest point of the plane.
    Eigen::Vector3d project(const Eigen::Vector3d& p) const { return p - signed_distance(p) * normal; }
    /// The same plane with the normal reversed.
    Plane flipped() const { return {-normal, -d}; }
};

/// The plane in frame b: n_b = R n_a, d_b = d_a - n_b.t (paper section 2.3).
Plane operator*(const Pose& b_from_a, const Plane& plane_a);

/// Angle between two normals in radians, in [0, pi]: 0 for the same orientation, pi for opposite sides.
double angle_between(const Eigen::Vector3d& normal_a, const Eigen::Vector3d& normal_b);

/// True when the values are finite and the normal has unit length within 1e-6.
bool is_valid(const Plane& plane);

}  // namespace planemap
