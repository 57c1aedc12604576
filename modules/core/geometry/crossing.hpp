// SPDX-License-Identifier: BSD-3-Clause
// Edges of outlines that cross, which those of a finished outline do not.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/outline.hpp"

namespace planemap {

/// True when two edges of the rings cross at inner points of both. Touching is not crossing.
bool rings_cross(const Outline& outline);

/// Makes rings that do not cross of ones that do, one outline after the other with the same memory.
class CrossingRemover {
  public:
    /// Leaves out vertices until no edges cross: of two that do, the end whose corner encloses least. Rings
    /// left with fewer than three vertices go. Returns how many vertices were left out.
    int remove(Outline& outline);

    struct Edge {
        Eigen::Vector2d a, b;
        double x_min, x_max;
        std::size_t ring, from, to;  ///< where a and b stand
    };

  private:
    std::vector<Edge> edges_;
};

}  // namespace planemap
