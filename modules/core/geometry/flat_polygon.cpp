// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/flat_polygon.hpp"

#include "core/geometry/segment.hpp"

namespace planemap {

void FlatPolygon::assign(const Outline& outline) {
    clear();
    for (const Ring& ring : outline.rings) {
        vertices.insert(vertices.end(), ring.begin(), ring.end());
        ring_ends.push_back(vertices.size());
    }
}

bool contains(const FlatPolygon& polygon, const Eigen::Vector2d& p) {
    bool inside = false;
    for_each_edge(polygon, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        inside ^= passes_right_of(p, to, from);
    });
    return inside;
}

}  // namespace planemap
