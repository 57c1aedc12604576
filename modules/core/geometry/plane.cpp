// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/plane.hpp"

#include <cmath>

namespace planemap {

Plane operator*(const Pose& b_from_a, const Plane& plane_a) {
    const Eigen::Vector3d normal_b = b_from_a.linear() * plane_a.normal;
    return {normal_b, plane_a.d - normal_b.dot(b_from_a.translation())};
}

double angle_between(const Eigen::Vector3d& normal_a, const Eigen::Vector3d& normal_b) {
    return std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
}

bool is_valid(const Plane& plane) {
    return plane.normal.allFinite() && std::isfinite(plane.d) && std::abs(plane.normal.norm() - 1.0) < 1e-6;
}

}  // namespace planemap
