// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/geometry/bitmap.hpp"
#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/outline_index.hpp"
#include "core/geometry/segment.hpp"

namespace planemap {

namespace {

/// Even-odd rule for one ring.
bool contains(const Ring& ring, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        if (passes_right_of(p, ring[i], ring[j])) inside = !inside;
    }
    return inside;
}

/// Marks the vertices to keep between first and last, by Douglas and Peucker.
void mark_kept(const Ring& path, std::size_t first, std::size_t last, double tolerance,
               RingSimplifier::Buffers& buffers) {
    auto& pending = buffers.pending;
    pending.assign(1, {first, last});
    while (!pending.empty()) {
        const auto [from, to] = pending.back();
        pending.pop_back();
        const Eigen::Vector2d& a = path[from];
        const Eigen::Vector2d ab = path[to] - a;
        const double length2 = ab.squaredNorm(), per_length2 = length2 > 0 ? 1 / length2 : 0;
        double worst = tolerance * tolerance;
        std::size_t worst_at = from;
        for (std::size_t i = from + 1; i < to; ++i) {
            const Eigen::Vector2d ap = path[i] - a;
            const double along = std::clamp(ap.dot(ab) * per_length2, 0.0, 1.0);
            const double distance2 = (ap - along * ab).squaredNorm();
            if (distance2 > worst) worst = distance2, worst_at = i;
        }
        if (worst_at == from) continue;
        buffers.keep[worst_at] = 1;
        pending.emplace_back(from, worst_at);
        pending.emplace_back(worst_at, to);
    }
}

}  // namespace

std::size_t Outline::vertex_count() const {
    std::size_t count = 0;
    for (const Ring& ring : rings) count += ring.size();
    return count;
}

double signed_area(const Ring& ring) {
    double twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) twice += cross(ring[i], ring[(i + 1) % ring.size()]);
    return 0.5 * twice;
}

double area(const Outline& outline) {
    // Rings do not cross, so a ring counts as solid or hole by how many others hold it: an even or an odd
    // number. To ask each other ring is the fastest for a few, and never ends for the many of a map's dust.
    constexpr std::size_t kFew = 8;
    std::optional<OutlineIndex> index;
    if (outline.rings.size() > kFew) index.emplace(outline);
    double total = 0;
    for (std::size_t i = 0; i < outline.rings.size(); ++i) {
        const Ring& ring = outline.rings[i];
        if (ring.size() < 3) continue;
        // The midpoint of an edge, so that rings that share a vertex do not confuse the test.
        const Eigen::Vector2d probe = 0.5 * (ring[0] + ring[1]);
        std::size_t depth = 0;
        if (index) {
            const auto around = index->rings_around(probe);
            depth = around.size() - static_cast<std::size_t>(std::count(around.begin(), around.end(), i));
        } else {
            for (std::size_t j = 0; j < outline.rings.size(); ++j)
                depth += j != i && contains(outline.rings[j], probe);
        }
        total += (depth % 2 == 0 ? 1.0 : -1.0) * std::abs(signed_area(ring));
    }
    return total;
}

bool contains(const Outline& outline, const Eigen::Vector2d& p) {
    bool inside = false;
    for (const Ring& ring : outline.rings) inside ^= contains(ring, p);
    return inside;
}

double distance(const Outline& outline, const Eigen::Vector2d& p) {
    if (contains(outline, p)) return 0;
    double nearest = std::numeric_limits<double>::infinity();
    for_each_edge(outline, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        nearest = std::min(nearest, distance_to_segment(p, from, to));
    });
    return nearest;
}

void RingSimplifier::simplify(Ring& ring, double tolerance) {
    if (ring.size() < 3) return ring.clear();
    // Two anchors that are certainly kept: the lexicographically smallest vertex and the one farthest from
    // it. The path goes from the first of them around to it again.
    std::size_t anchor = 0, far = 0;
    for (std::size_t i = 1; i < ring.size(); ++i) {
        if (std::pair(ring[i].x(), ring[i].y()) < std::pair(ring[anchor].x(), ring[anchor].y())) anchor = i;
    }
    Ring& path = buffers_.path;
    path.assign(ring.begin() + static_cast<std::ptrdiff_t>(anchor), ring.end());
    path.insert(path.end(), ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(anchor) + 1);
    double farthest = 0;
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
        const double distance2 = (path[i] - path[0]).squaredNorm();
        if (distance2 > farthest) farthest = distance2, far = i;
    }
    if (far == 0) return ring.clear();
    buffers_.keep.assign(path.size(), 0);
    buffers_.keep[0] = buffers_.keep[far] = 1;
    mark_kept(path, 0, far, tolerance, buffers_);
    mark_kept(path, far, path.size() - 1, tolerance, buffers_);
    ring.clear();
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        if (buffers_.keep[i] != 0) ring.push_back(path[i]);
    }
    if (ring.size() < 3 || signed_area(ring) == 0) ring.clear();
}

std::vector<std::size_t> kept_vertices(const Ring& ring, const std::vector<std::uint8_t>& fixed,
                                       double tolerance) {
    if (ring.size() < 3) return {};
    const std::size_t n = ring.size();
    const auto farthest_from = [&](const Eigen::Vector2d& p) {
        const auto nearer = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
            return (a - p).squaredNorm() < (b - p).squaredNorm();
        };
        return static_cast<std::size_t>(std::max_element(ring.begin(), ring.end(), nearer) - ring.begin());
    };
    // Two that are corners of whatever shape it is: the farthest from the middle, and from that one.
    std::vector<std::uint8_t> anchors = fixed;
    std::size_t anchor = static_cast<std::size_t>(std::find(fixed.begin(), fixed.end(), 1) - fixed.begin());
    if (anchor == n) {
        anchor = farthest_from(std::accumulate(ring.begin(), ring.end(), Eigen::Vector2d(0, 0)) /
                               static_cast<double>(n));
        anchors[anchor] = 1;
    }
    if (std::count(anchors.begin(), anchors.end(), 1) == 1) anchors[farthest_from(ring[anchor])] = 1;
    RingSimplifier::Buffers buffers;
    buffers.keep.assign(n + 1, 0);
    for (std::size_t i = 0; i <= n; ++i) {
        buffers.path.push_back(ring[(anchor + i) % n]);
        buffers.keep[i] = anchors[(anchor + i) % n];
    }
    const std::vector<std::uint8_t> ends = buffers.keep;
    for (std::size_t from = 0, to = 1; to <= n; ++to) {
        if (ends[to] == 0) continue;
        mark_kept(buffers.path, from, to, tolerance, buffers);
        from = to;
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < n; ++i)
        if (buffers.keep[i] != 0) kept.push_back((anchor + i) % n);
    std::sort(kept.begin(), kept.end());
    return kept;
}

Outline simplified(const Outline& outline, double tolerance) {
    RingSimplifier simplifier;
    Outline result;
    for (Ring ring : outline.rings) {
        simplifier.simplify(ring, tolerance);
        if (!ring.empty()) result.rings.push_back(std::move(ring));
    }
    return result;
}

void fill(const Outline& outline, Mask& mask) {
    FlatPolygon polygon;
    polygon.assign(outline);
    Bitmap inside(0, 0, (mask.width + 63) / 64, mask.height);
    const Eigen::Vector2d first_centre(0.5, 0.5);
    inside.draw(polygon, [&](const Eigen::Vector2d& v) -> Eigen::Vector2d { return v - first_centre; });
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (inside.at(x, y)) mask.set(x, y);
        }
    }
}

}  // namespace planemap
