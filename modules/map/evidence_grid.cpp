// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace planemap {

namespace {

struct Edge {
    Eigen::Vector2d a, b;
    double x_min, x_max;
};

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool cross_properly(const Edge& e, const Edge& f) {
    if (std::max(e.a.y(), e.b.y()) < std::min(f.a.y(), f.b.y())) return false;
    if (std::max(f.a.y(), f.b.y()) < std::min(e.a.y(), e.b.y())) return false;
    return turn(e.a, e.b, f.a) * turn(e.a, e.b, f.b) < 0 && turn(f.a, f.b, e.a) * turn(f.a, f.b, e.b) < 0;
}

/// Simplified as far as the tolerance allows without rings that cross.
Outline simplified_without_crossings(const Outline& outline, double tolerance) {
    for (int attempt = 0; attempt < 4; ++attempt, tolerance /= 2) {
        Outline simple = simplified(outline, tolerance);
        if (!rings_cross(simple)) return simple;
    }
    return outline;
}

}  // namespace

bool rings_cross(const Outline& outline) {
    std::vector<Edge> edges;
    edges.reserve(outline.vertex_count());
    for (const Ring& ring : outline.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            edges.push_back(
                {ring[j], ring[i], std::min(ring[i].x(), ring[j].x()), std::max(ring[i].x(), ring[j].x())});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) { return e.x_min < f.x_min; });
    for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = i + 1; j < edges.size() && edges[j].x_min <= edges[i].x_max; ++j) {
            if (cross_properly(edges[i], edges[j])) return true;
        }
    }
    return false;
}

EvidenceGrid::Cells EvidenceGrid::cells_around(std::span<const Eigen::Vector2d> points) const {
    Eigen::Vector2d low = points[0], high = points[0];
    for (const auto& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const auto cell = [this](double metres) { return static_cast<int>(std::floor(metres / cell_m_)); };
    return {cell(low.x()), cell(low.y()), cell(high.x()) + 1, cell(high.y()) + 1};
}

void EvidenceGrid::grow(const Cells& needed) {
    if (!views_.empty() && needed.x0 >= x0_ && needed.y0 >= y0_ && needed.x1 <= x0_ + width_ &&
        needed.y1 <= y0_ + height_) {
        return;
    }
    // Some room to spare on the sides that grow, so that a plane explored slowly is not copied every time.
    Cells to = needed;
    if (!views_.empty()) {
        const int spare_x = 8 + width_ / 8, spare_y = 8 + height_ / 8;
        to.x0 = needed.x0 < x0_ ? needed.x0 - spare_x : x0_;
        to.y0 = needed.y0 < y0_ ? needed.y0 - spare_y : y0_;
        to.x1 = needed.x1 > x0_ + width_ ? needed.x1 + spare_x : x0_ + width_;
        to.y1 = needed.y1 > y0_ + height_ ? needed.y1 + spare_y : y0_ + height_;
    }
    const int width = to.x1 - to.x0, height = to.y1 - to.y0;
    std::vector<std::uint8_t> views(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (int y = y0_; y < y0_ + height_; ++y) {
        const std::uint8_t* from = row(y) + x0_;
        std::copy(from, from + width_,
                  views.begin() + static_cast<std::ptrdiff_t>(y - to.y0) * width + (x0_ - to.x0));
    }
    views_ = std::move(views);
    x0_ = to.x0, y0_ = to.y0, width_ = width, height_ = height;
}

void EvidenceGrid::add(const Outline& outline_grid) {
    std::vector<Eigen::Vector2d> vertices;
    for (const Ring& ring : outline_grid.rings) vertices.insert(vertices.end(), ring.begin(), ring.end());
    if (vertices.empty()) return;
    const Cells cells = cells_around(vertices);
    grow(cells);

    // Each edge flips, in every row whose centre line it crosses, all cells to its right: what is flipped an
    // odd number of times is inside. One column more, for flips right of the last cell.
    const int width = cells.x1 - cells.x0 + 1, height = cells.y1 - cells.y0;
    std::vector<std::uint8_t> flips(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (const Ring& ring : outline_grid.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            const Eigen::Vector2d origin(cells.x0 + 0.5, cells.y0 + 0.5);  // centre of the first cell
            Eigen::Vector2d a = ring[j] / cell_m_ - origin, b = ring[i] / cell_m_ - origin;
            if (a.y() > b.y()) std::swap(a, b);
            const int from = std::max(0, static_cast<int>(std::ceil(a.y())));
            const int to = std::min(height, static_cast<int>(std::ceil(b.y())));
            const double slope = (b.x() - a.x()) / (b.y() - a.y());
            for (int y = from; y < to; ++y) {
                const double x = std::ceil(a.x() + (y - a.y()) * slope);
                flips[static_cast<std::size_t>(y * width + std::clamp(static_cast<int>(x), 0, width - 1))] ^=
                    1;
            }
        }
    }
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* flip = flips.data() + static_cast<std::ptrdiff_t>(y) * width;
        std::uint8_t* view = row(cells.y0 + y) + cells.x0;
        std::uint8_t inside = 0;
        for (int x = 0; x + 1 < width; ++x) {
            inside = static_cast<std::uint8_t>(inside ^ flip[x]);
            view[x] = static_cast<std::uint8_t>(view[x] + (inside & (view[x] != 255)));
        }
    }
}

void EvidenceGrid::add(const EvidenceGrid& other) {
    if (other.empty()) return;
    const Pose other_from_grid = other.world_from_grid_.inverse(Eigen::Isometry) * world_from_grid_;
    const Pose grid_from_other = other_from_grid.inverse(Eigen::Isometry);
    std::array<Eigen::Vector2d, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = other.cell_m_ * (other.x0_ + (i & 1 ? other.width_ : 0));
        const double y = other.cell_m_ * (other.y0_ + (i & 2 ? other.height_ : 0));
        corners[i] = (grid_from_other * Eigen::Vector3d(x, y, 0)).head<2>();
    }
    const Cells cells = cells_around(corners);
    grow(cells);
    for (int y = cells.y0; y < cells.y1; ++y) {
        std::uint8_t* view = row(y);
        for (int x = cells.x0; x < cells.x1; ++x) {
            const Eigen::Vector3d centre(cell_m_ * (x + 0.5), cell_m_ * (y + 0.5), 0);
            const int views = view[x] + other.views((other_from_grid * centre).head<2>());
            view[x] = static_cast<std::uint8_t>(std::min(views, 255));
        }
    }
}

int EvidenceGrid::views(const Eigen::Vector2d& p_grid) const {
    const double x = std::floor(p_grid.x() / cell_m_) - x0_, y = std::floor(p_grid.y() / cell_m_) - y0_;
    if (!(x >= 0 && y >= 0 && x < width_ && y < height_)) return 0;
    return views_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
}

Outline EvidenceGrid::outline(const OutlineOptions& options) const {
    Mask mask(width_, height_);
    for (std::size_t i = 0; i < views_.size(); ++i) mask.cells[i] = views_[i] >= options.min_views;
    Outline outline = trace(mask);
    std::erase_if(outline.rings, [&](const Ring& ring) {
        return std::abs(signed_area(ring)) * cell_m_ * cell_m_ < options.min_ring_m2;
    });
    for (Ring& ring : outline.rings) {
        for (Eigen::Vector2d& vertex : ring) vertex = cell_m_ * (vertex + Eigen::Vector2d(x0_, y0_));
    }
    return simplified_without_crossings(outline, options.tolerance_m);
}

}  // namespace planemap
