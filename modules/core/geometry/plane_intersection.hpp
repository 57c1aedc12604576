// SPDX-License-Identifier: BSD-3-Clause
// Where planes without end meet: two in a line, three in a point.
#pragma once

#include <optional>

#include "core/geometry/angle.hpp"
#include "core/geometry/plane.hpp"

namespace planemap {

/// Flatter pairs of planes count as parallel: what they are to each other is a distance, and their line,
/// which moves by four times their error and more, says little.
inline constexpr double kParallel_deg = 15;
inline constexpr double kParallel_rad = radians(kParallel_deg);

struct Line {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit
};

/// The line that both planes hold, along the cross product of their normals; its origin is its point nearest
/// to `near`. Nothing for planes whose angle has less than `least_sine`.
std::optional<Line> common_line(const Plane& a, const Plane& b, const Eigen::Vector3d& near,
                                double least_sine);

/// What the normals of three planes span at least, as a parallelepiped, whose point is as well-defined as the
/// line of two planes at this angle: it is the square of its sine, as of two such angles square to each
/// other.
double least_volume(double angle_rad);

/// The point that three planes hold. Nothing if their normals span less than `least_volume`: the planes
/// nearly share a line.
std::optional<Eigen::Vector3d> common_point(const Plane& a, const Plane& b, const Plane& c,
                                            double least_volume);

}  // namespace planemap
