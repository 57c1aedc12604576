// SPDX-License-Identifier: BSD-3-Clause
#include "core/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/outline_index.hpp"
#include "core/segment.hpp"

namespace planemap {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Even-odd rule for one ring.
bool contains(const Ring& ring, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const Eigen::Vector2d &a = ring[i], &b = ring[j];
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) inside = !inside;
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
        const Eigen::Vector2d a = path[from], ab = path[to] - a;
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
    for (const Ring& ring : outline.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            nearest = std::min(nearest, distance_to_segment(p, ring[j], ring[i]));
        }
    }
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

Outline simplified(const Outline& outline, double tolerance) {
    RingSimplifier simplifier;
    Outline result;
    for (Ring ring : outline.rings) {
        simplifier.simplify(ring, tolerance);
        if (!ring.empty()) result.rings.push_back(std::move(ring));
    }
    return result;
}

Outline trace(const Mask& mask) {
    // Each set cell contributes directed edges counter-clockwise around it where its neighbour is not set. An
    // edge is named by its start corner and direction (0: +x, 1: +y, 2: -x, 3: -y); following them gives the
    // rings.
    const int corners_wide = mask.width + 1;
    const auto corner = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(corners_wide) +
               static_cast<std::size_t>(x);
    };
    std::vector<std::uint8_t> edges(corner(0, mask.height + 1), 0);
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.at(x, y)) continue;
            if (!mask.at(x, y - 1)) edges[corner(x, y)] |= 1;
            if (!mask.at(x + 1, y)) edges[corner(x + 1, y)] |= 2;
            if (!mask.at(x, y + 1)) edges[corner(x + 1, y + 1)] |= 4;
            if (!mask.at(x - 1, y)) edges[corner(x, y + 1)] |= 8;
        }
    }
    constexpr std::array<int, 4> dx{1, 0, -1, 0}, dy{0, 1, 0, -1};
    Outline outline;
    for (int y = 0; y <= mask.height; ++y) {
        for (int x = 0; x <= mask.width; ++x) {
            while (edges[corner(x, y)] != 0) {
                Ring ring;
                int cx = x, cy = y, previous = -1;
                int direction = 0;
                while ((edges[corner(cx, cy)] >> direction & 1) == 0) ++direction;
                const int first = direction;
                do {
                    edges[corner(cx, cy)] =
                        static_cast<std::uint8_t>(edges[corner(cx, cy)] & ~(1 << direction));
                    if (direction != previous) ring.emplace_back(cx, cy);
                    previous = direction;
                    cx += dx[static_cast<std::size_t>(direction)];
                    cy += dy[static_cast<std::size_t>(direction)];
                    // Turn left where two rings meet at a corner: cells that touch there stay apart.
                    const std::uint8_t here = edges[corner(cx, cy)];
                    const int left = (direction + 1) % 4, right = (direction + 3) % 4;
                    if (here >> left & 1) {
                        direction = left;
                    } else if (here >> direction & 1) {
                        // straight on
                    } else if (here >> right & 1) {
                        direction = right;
                    } else {
                        break;
                    }
                } while (true);
                if (previous == first && ring.size() > 1) ring.erase(ring.begin());
                outline.rings.push_back(std::move(ring));
            }
        }
    }
    return outline;
}

void fill(const Outline& outline, Mask& mask) {
    std::vector<double> crossings;
    for (int y = 0; y < mask.height; ++y) {
        const double centre = y + 0.5;
        crossings.clear();
        for (const Ring& ring : outline.rings) {
            for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
                const Eigen::Vector2d &a = ring[i], &b = ring[j];
                if ((a.y() > centre) == (b.y() > centre)) continue;
                const double crossing = (b.x() - a.x()) * (centre - a.y()) / (b.y() - a.y()) + a.x();
                if (std::isfinite(crossing)) crossings.push_back(crossing);
            }
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
            const double low = std::clamp(crossings[k] - 0.5, -1.0, static_cast<double>(mask.width));
            const double high = std::clamp(crossings[k + 1] - 0.5, -1.0, static_cast<double>(mask.width));
            for (int x = std::max(0, static_cast<int>(std::ceil(low))); x < mask.width && x < high; ++x)
                mask.set(x, y);
        }
    }
}

Ring convex_hull(std::span<const Eigen::Vector2d> points) {
    std::vector<Eigen::Vector2d> sorted(points.begin(), points.end());
    const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
    };
    std::sort(sorted.begin(), sorted.end(), less);
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (sorted.size() < 3) return {};
    Ring hull;  // Andrew's monotone chain: lower hull, then upper
    const auto extend = [&](const Eigen::Vector2d& p, std::size_t keep) {
        while (hull.size() > keep && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const auto& p : sorted) extend(p, 1);
    const std::size_t lower = hull.size();
    for (std::size_t i = sorted.size() - 1; i-- > 0;) extend(sorted[i], lower);
    hull.pop_back();
    if (hull.size() < 3) return {};
    return hull;
}

}  // namespace planemap
