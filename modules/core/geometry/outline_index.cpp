// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/outline_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/geometry/segment.hpp"

namespace planemap {

namespace {

constexpr double kBandsPerEdge = 8;  ///< entries of the bands for each edge, about
constexpr double kMostBands = 65536;

}  // namespace

OutlineIndex::OutlineIndex(const Outline& outline) {
    double y_max = -std::numeric_limits<double>::infinity(), tall = 0;
    y_min_ = -y_max;
    for (std::size_t r = 0; r < outline.rings.size(); ++r) {
        const Ring& ring = outline.rings[r];
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            edges_.push_back({ring[i], ring[j], r});
            y_min_ = std::min(y_min_, ring[i].y());
            y_max = std::max(y_max, ring[i].y());
            tall += std::abs(ring[i].y() - ring[j].y());
        }
    }
    if (edges_.empty()) y_min_ = y_max = 0;
    // As many bands as keep the lists short when all edges are tall.
    const double height = y_max - y_min_;
    const double wanted = tall > 0 ? kBandsPerEdge * static_cast<double>(edges_.size()) * height / tall : 1;
    const double bands = std::clamp(std::floor(wanted), 1.0, kMostBands);
    bands_per_metre_ = height > 0 ? bands / height : 0;
    starts_.assign(static_cast<std::size_t>(bands) + 1, 0);
    const auto for_bands = [&](const Edge& edge, auto visit) {
        const std::size_t last = band(std::max(edge.a.y(), edge.b.y()));
        for (std::size_t at = band(std::min(edge.a.y(), edge.b.y())); at <= last; ++at) visit(at);
    };
    for (const Edge& edge : edges_) for_bands(edge, [&](std::size_t at) { ++starts_[at + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    members_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t i = 0; i < edges_.size(); ++i)
        for_bands(edges_[i], [&](std::size_t at) { members_[next[at]++] = i; });
}

/// Grows with y, so that an edge lies in the band of each of its points.
std::size_t OutlineIndex::band(double y) const {
    const double last = static_cast<double>(starts_.size() - 2);
    return static_cast<std::size_t>(std::clamp((y - y_min_) * bands_per_metre_, 0.0, last));
}

/// Visits the ring of each edge that lies beyond p on the line to the right of it.
template <typename Visit>
void OutlineIndex::for_edges_beyond(const Eigen::Vector2d& p, Visit visit) const {
    const std::size_t at = band(p.y());
    for (std::uint32_t m = starts_[at]; m < starts_[at + 1]; ++m) {
        const auto& [a, b, ring] = edges_[members_[m]];
        if (passes_right_of(p, a, b)) visit(ring);
    }
    work_ += starts_[at + 1] - starts_[at];
}

void OutlineIndex::crossings(double y, std::vector<double>& xs) const {
    xs.clear();
    const std::size_t at = band(y);
    for (std::uint32_t m = starts_[at]; m < starts_[at + 1]; ++m) {
        const auto& [a, b, ring] = edges_[members_[m]];
        if (crosses(a, b, y)) xs.push_back(x_of_crossing(a, b, y));
    }
    work_ += starts_[at + 1] - starts_[at];
}

bool OutlineIndex::contains(const Eigen::Vector2d& p) const {
    bool inside = false;
    for_edges_beyond(p, [&](std::size_t) { inside = !inside; });
    return inside;
}

std::vector<std::size_t> OutlineIndex::rings_around(const Eigen::Vector2d& p) const {
    std::vector<std::size_t> beyond, around;
    for_edges_beyond(p, [&](std::size_t ring) { beyond.push_back(ring); });
    std::sort(beyond.begin(), beyond.end());
    for (std::size_t i = 0; i < beyond.size(); ++i) {
        // A ring is named once for each of its edges: an odd number of times if it holds the point.
        if (around.empty() || around.back() != beyond[i]) {
            around.push_back(beyond[i]);
        } else {
            around.pop_back();
        }
    }
    return around;
}

double OutlineIndex::distance_within(const Eigen::Vector2d& p, double reach) const {
    if (contains(p)) return 0;
    double nearest = std::numeric_limits<double>::infinity();
    const std::uint32_t from = starts_[band(p.y() - reach)], to = starts_[band(p.y() + reach) + 1];
    for (std::uint32_t m = from; m < to; ++m) {
        const auto& [a, b, ring] = edges_[members_[m]];
        if (std::min(a.x(), b.x()) > p.x() + reach || std::max(a.x(), b.x()) < p.x() - reach) continue;
        nearest = std::min(nearest, distance_to_segment(p, b, a));
    }
    work_ += to - from;
    return nearest <= reach ? nearest : std::numeric_limits<double>::infinity();
}

}  // namespace planemap
