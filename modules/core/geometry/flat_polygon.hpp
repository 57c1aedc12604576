// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/outline.hpp"

namespace planemap {

/// A polygon with holes for drawing: the vertices of all rings one after the other. Even-odd rule.
struct FlatPolygon {
    std::vector<Eigen::Vector2d> vertices;
    std::vector<std::size_t> ring_ends;  ///< past the last vertex of each ring

    void clear() {
        vertices.clear();
        ring_ends.clear();
    }
    void assign(const Outline& outline);
};

/// Calls edge(from, to) for every edge of the polygon.
template <typename Edge>
void for_each_edge(const FlatPolygon& polygon, const Edge& edge) {
    std::size_t begin = 0;
    for (const std::size_t end : polygon.ring_ends) {
        for (std::size_t i = begin, j = end - 1; i < end; j = i++)
            edge(polygon.vertices[j], polygon.vertices[i]);
        begin = end;
    }
}

/// True when the polygon holds the point (even-odd rule).
bool contains(const FlatPolygon& polygon, const Eigen::Vector2d& p);

}  // namespace planemap
