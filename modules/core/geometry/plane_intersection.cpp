// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/plane_intersection.hpp"

#include <Eigen/LU>
#include <cmath>

namespace planemap {

std::optional<Line> common_line(const Plane& a, const Plane& b, const Eigen::Vector3d& near,
                                double least_sine) {
    const Eigen::Vector3d cross = a.normal.cross(b.normal);
    const double sine = cross.norm();
    if (!(sine >= least_sine)) return std::nullopt;
    Line line;
    line.direction = cross / sine;
    // From the foot on plane a, within plane a and square to the line, to plane b.
    const Eigen::Vector3d foot = a.project(near);
    const Eigen::Vector3d across = line.direction.cross(a.normal);
    line.origin = foot - across * (b.signed_distance(foot) / b.normal.dot(across));
    return line.origin.allFinite() ? std::optional(line) : std::nullopt;
}

double least_volume(double angle_rad) {
    return std::pow(std::sin(angle_rad), 2);
}

std::optional<Eigen::Vector3d> common_point(const Plane& a, const Plane& b, const Plane& c,
                                            double least_volume) {
    Eigen::Matrix3d normals;
    normals << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
    if (!(std::abs(normals.determinant()) >= least_volume)) return std::nullopt;
    return Eigen::Vector3d(normals.inverse() * Eigen::Vector3d(-a.d, -b.d, -c.d));
}

}  // namespace planemap
