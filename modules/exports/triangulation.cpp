// SPDX-License-Identifier: BSD-3-Clause
#include "exports/triangulation.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace planemap::exports {

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

/// The edges that reach over a height, as it rises: so that an edge meets those beside it and not all.
class Sweep {
  public:
    explicit Sweep(const std::vector<Edge>& edges) : edges_(edges), order_(edges.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(),
                         [&](std::size_t a, std::size_t b) { return edges[a].low.y() < edges[b].low.y(); });
    }
    /// Edges by ascending low end.
    const std::vector<std::size_t>& order() const { return order_; }
    /// Edges that begin at y or below and end above it, in no order. y must not descend.
    const std::vector<std::size_t>& active_at(double y) {
        std::erase_if(active_, [&](std::size_t i) { return edges_[i].high.y() <= y; });
        for (; next_ < order_.size() && edges_[order_[next_]].low.y() <= y; ++next_) {
            if (edges_[order_[next_]].high.y() > y) active_.push_back(order_[next_]);
        }
        return active_;
    }

  private:
    const std::vector<Edge>& edges_;
    std::vector<std::size_t> order_, active_;
    std::size_t next_ = 0;
};

/// Heights between which no edge ends and no two edges cross.
std::vector<double> slab_heights(const std::vector<Edge>& edges) {
    std::vector<double> heights;
    const auto compare = [&](const Edge& a, const Edge& b) {
        const double from = std::max(a.low.y(), b.low.y()), to = std::min(a.high.y(), b.high.y());
        if (from >= to) return;
        const double before = a.x_at(from) - b.x_at(from), after = a.x_at(to) - b.x_at(to);
        if (before * after < 0) heights.push_back(from + before / (before - after) * (to - from));
    };
    Sweep reached(edges);
    for (const std::size_t i : reached.order()) {
        heights.push_back(edges[i].low.y());
        heights.push_back(edges[i].high.y());
        // Each pair once: when the later one begins; of those that begin together, those before it.
        for (const std::size_t j : reached.active_at(edges[i].low.y())) {
            const bool together = edges[j].low.y() == edges[i].low.y();
            if (together ? j < i : edges[j].low.y() < edges[i].low.y()) compare(edges[i], edges[j]);
        }
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    return heights;
}

/// Edges between which the slab lies inside, from left to right. `active` are those that reach over it.
std::vector<std::pair<std::size_t, std::size_t>> spans(const std::vector<Edge>& edges,
                                                       const std::vector<std::size_t>& active, double from,
                                                       double to) {
    const double middle = 0.5 * (from + to);
    std::vector<std::pair<double, std::size_t>> by_x;
    by_x.reserve(active.size());
    for (const std::size_t i : active) by_x.emplace_back(edges[i].x_at(middle), i);
    std::sort(by_x.begin(), by_x.end());
    std::vector<std::pair<std::size_t, std::size_t>> result;
    for (std::size_t k = 0; k + 1 < by_x.size(); k += 2)
        result.emplace_back(by_x[k].second, by_x[k + 1].second);
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
    Sweep sweep(edges);
    // A trapezoid goes on through the slabs as long as it has the same edges left and right.
    std::map<std::pair<std::size_t, std::size_t>, double> open;  // edges: height it began at
    for (std::size_t i = 0; i < heights.size(); ++i) {
        std::map<std::pair<std::size_t, std::size_t>, double> next;
        if (i + 1 < heights.size()) {
            for (const auto& span : spans(edges, sweep.active_at(heights[i]), heights[i], heights[i + 1])) {
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

}  // namespace planemap::exports
