// SPDX-License-Identifier: BSD-3-Clause
#include "map/triangulation.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace planemap {

namespace {

/// An edge that is not horizontal, upwards.
struct Edge {
    Eigen::Vector2d low, high;

    double x_at(double y) const {
        if (y == low.y()) return low.x();
        if (y == high.y()) return high.x();
        return low.x() + (y - low.y()) * (high.x() - low.x()) / (high.y() - low.y());
    }
};

std::vector<Edge> edges_of(const Outline& outline) {
    std::vector<Edge> edges;
    for (const Ring& ring : outline.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            if (ring[i].y() > ring[j].y()) edges.push_back({ring[j], ring[i]});
            if (ring[i].y() < ring[j].y()) edges.push_back({ring[i], ring[j]});
        }
    }
    return edges;
}

/// Heights between which no edge ends and no two edges cross.
std::vector<double> slab_heights(const std::vector<Edge>& edges) {
    std::vector<double> heights;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        heights.push_back(edges[i].low.y());
        heights.push_back(edges[i].high.y());
        for (std::size_t j = 0; j < i; ++j) {
            const double from = std::max(edges[i].low.y(), edges[j].low.y());
            const double to = std::min(edges[i].high.y(), edges[j].high.y());
            if (from >= to) continue;
            const double before = edges[i].x_at(from) - edges[j].x_at(from);
            const double after = edges[i].x_at(to) - edges[j].x_at(to);
            if (before * after < 0) heights.push_back(from + before / (before - after) * (to - from));
        }
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    return heights;
}

/// Edges between which the slab lies inside, from left to right.
std::vector<std::pair<std::size_t, std::size_t>> spans(const std::vector<Edge>& edges, double from,
                                                       double to) {
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].low.y() <= from && edges[i].high.y() >= to) active.push_back(i);
    }
    const double middle = 0.5 * (from + to);
    std::sort(active.begin(), active.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(edges[a].x_at(middle), a) < std::pair(edges[b].x_at(middle), b);
    });
    std::vector<std::pair<std::size_t, std::size_t>> result;
    for (std::size_t k = 0; k + 1 < active.size(); k += 2) result.emplace_back(active[k], active[k + 1]);
    return result;
}

class Builder {
  public:
    void add_trapezoid(const Edge& left, const Edge& right, double from, double to) {
        const int a = vertex(left.x_at(from), from), b = vertex(right.x_at(from), from);
        const int c = vertex(right.x_at(to), to), d = vertex(left.x_at(to), to);
        if (a != b) result.triangles.push_back({a, b, c});
        if (c != d) result.triangles.push_back({a, c, d});
    }

    Triangulation result;

  private:
    int vertex(double x, double y) {
        const auto [at, is_new] =
            index_.try_emplace(std::pair(x, y), static_cast<int>(result.vertices.size()));
        if (is_new) result.vertices.emplace_back(x, y);
        return at->second;
    }

    std::map<std::pair<double, double>, int> index_;
};

}  // namespace

Triangulation triangulate(const Outline& outline) {
    const std::vector<Edge> edges = edges_of(outline);
    const std::vector<double> heights = slab_heights(edges);
    Builder builder;
    // A trapezoid goes on through the slabs as long as it has the same edges left and right.
    std::map<std::pair<std::size_t, std::size_t>, double> open;  // edges: height it began at
    for (std::size_t i = 0; i < heights.size(); ++i) {
        std::map<std::pair<std::size_t, std::size_t>, double> next;
        if (i + 1 < heights.size()) {
            for (const auto& span : spans(edges, heights[i], heights[i + 1])) {
                const auto known = open.find(span);
                next[span] = known == open.end() ? heights[i] : known->second;
            }
        }
        for (const auto& [span, from] : open) {
            if (!next.contains(span))
                builder.add_trapezoid(edges[span.first], edges[span.second], from, heights[i]);
        }
        open = std::move(next);
    }
    return std::move(builder.result);
}

}  // namespace planemap
