// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace planemap {

namespace {

using Edge = CrossingRemover::Edge;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool cross_properly(const Edge& e, const Edge& f) {
    if (std::max(e.a.y(), e.b.y()) < std::min(f.a.y(), f.b.y())) return false;
    if (std::max(f.a.y(), f.b.y()) < std::min(e.a.y(), e.b.y())) return false;
    return turn(e.a, e.b, f.a) * turn(e.a, e.b, f.b) < 0 && turn(f.a, f.b, e.a) * turn(f.a, f.b, e.b) < 0;
}

std::optional<std::array<Edge, 2>> find_crossing(const Outline& outline, std::vector<Edge>& edges) {
    edges.clear();
    edges.reserve(outline.vertex_count());
    for (std::size_t r = 0; r < outline.rings.size(); ++r) {
        const Ring& ring = outline.rings[r];
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            edges.push_back({ring[j], ring[i], std::min(ring[i].x(), ring[j].x()),
                             std::max(ring[i].x(), ring[j].x()), r, j, i});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) { return e.x_min < f.x_min; });
    for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = i + 1; j < edges.size() && edges[j].x_min <= edges[i].x_max; ++j) {
            if (cross_properly(edges[i], edges[j])) return std::array{edges[i], edges[j]};
        }
    }
    return std::nullopt;
}

}  // namespace

bool rings_cross(const Outline& outline) {
    std::vector<Edge> edges;
    return find_crossing(outline, edges).has_value();
}

int CrossingRemover::remove(Outline& outline) {
    int removed = 0;
    while (const auto crossing = find_crossing(outline, edges_)) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t ring_index = 0, vertex = 0;
        for (const Edge& edge : *crossing) {
            const Ring& ring = outline.rings[edge.ring];
            for (const std::size_t i : {edge.from, edge.to}) {
                const std::size_t before = (i + ring.size() - 1) % ring.size(), after = (i + 1) % ring.size();
                const double enclosed = std::abs(turn(ring[before], ring[i], ring[after]));
                if (enclosed >= least) continue;
                least = enclosed;
                ring_index = edge.ring;
                vertex = i;
            }
        }
        Ring& ring = outline.rings[ring_index];
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(vertex));
        ++removed;
        if (ring.size() < 3)
            outline.rings.erase(outline.rings.begin() + static_cast<std::ptrdiff_t>(ring_index));
    }
    return removed;
}

}  // namespace planemap
