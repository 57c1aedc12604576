// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "core/geometry/outline.hpp"

namespace planemap::exports {

/// Triangles that cover an outline's area once. Vertices that are not the outline's lie on its edges.
struct Triangulation {
    std::vector<Eigen::Vector2d> vertices;
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
};

/// Cuts the area under the even-odd rule into trapezoids with horizontal sides, and those into triangles.
/// Holes and separate parts need no preparation, and rings that cross, which Outline does not allow, still
/// give triangles that cover exactly their even-odd area. The number of triangles grows with the number of
/// vertices.
Triangulation triangulate(const Outline& outline);

}  // namespace planemap::exports
