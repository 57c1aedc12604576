// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/bitmap.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/geometry/parity.hpp"

namespace planemap {

/// Each edge flips, in every row whose centre line it crosses, all cells to its right: what is flipped an odd
/// number of times is inside. Only the first of them is marked here, the others follow at once for all edges.
void Bitmap::flip_right_of(Eigen::Vector2d a, Eigen::Vector2d b) {
    if (a.y() > b.y()) std::swap(a, b);
    if (!(a.y() < b.y())) return;  // along the rows, or not a number
    const double end = rows_;
    const int from = static_cast<int>(std::ceil(std::clamp(a.y(), 0.0, end)));
    const int to = static_cast<int>(std::ceil(std::clamp(b.y(), 0.0, end)));
    if (from >= to) return;
    const double slope = (b.x() - a.x()) / (b.y() - a.y());
    if (!std::isfinite(slope)) return;
    const double beyond = 64 * words_;
    double x = a.x() + (from - a.y()) * slope;
    for (int y = from; y < to; ++y, x += slope) {
        const double first = std::ceil(x);
        if (!(first < beyond)) continue;
        const int at = static_cast<int>(std::max(first, 0.0));
        (bits_.data() + static_cast<std::ptrdiff_t>(y) * words_)[at >> 6] ^= std::uint64_t{1} << (at & 63);
    }
}

void Bitmap::set_between_flips() {
    for (int y = 0; y < rows_; ++y) {
        planemap::set_between_flips(
            {bits_.data() + static_cast<std::ptrdiff_t>(y) * words_, static_cast<std::size_t>(words_)});
    }
}

std::size_t Bitmap::count() const {
    std::size_t total = 0;
    for (const std::uint64_t word : bits_) total += static_cast<std::size_t>(std::popcount(word));
    return total;
}

/// Each cell becomes the union (or, eroding, the intersection) of its 3 x 3 neighbourhood.
Bitmap Bitmap::widened_once(bool erode) const {
    const std::uint64_t flip = erode ? ~std::uint64_t{0} : 0;
    Bitmap along(word0_, y0_, words_, rows_), result(word0_, y0_, words_, rows_);
    for (int y = y0_; y < y0_ + rows_; ++y) {
        const std::uint64_t* from = row(y);
        std::uint64_t* to = along.row(y);
        for (int i = 0; i < words_; ++i) {
            // What is outside counts as not set: it erodes and does not widen.
            const std::uint64_t here = from[i] ^ flip;
            const std::uint64_t left = i > 0 ? from[i - 1] ^ flip : flip;
            const std::uint64_t right = i + 1 < words_ ? from[i + 1] ^ flip : flip;
            to[i] = here | here << 1 | left >> 63 | here >> 1 | right << 63;
        }
    }
    for (int y = y0_; y < y0_ + rows_; ++y) {
        std::uint64_t* to = result.row(y);
        for (int i = 0; i < words_; ++i) {
            const std::uint64_t below = y > y0_ ? along.row(y - 1)[i] : flip;
            const std::uint64_t above = y + 1 < y0_ + rows_ ? along.row(y + 1)[i] : flip;
            to[i] = (along.row(y)[i] | below | above) ^ flip;
        }
    }
    return result;
}

Bitmap Bitmap::opened(int r) const {
    Bitmap result = *this;
    for (int i = 0; i < r; ++i) result = result.widened_once(true);
    for (int i = 0; i < r; ++i) result = result.widened_once(false);
    return result;
}

Bitmap Bitmap::closed(int r) const {
    Bitmap result = *this;
    for (int i = 0; i < r; ++i) result = result.widened_once(false);
    for (int i = 0; i < r; ++i) result = result.widened_once(true);
    return result;
}

Bitmap& Bitmap::operator|=(const Bitmap& other) {
    for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i];
    return *this;
}

Bitmap& Bitmap::operator&=(const Bitmap& other) {
    for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] &= other.bits_[i];
    return *this;
}

Bitmap& Bitmap::operator-=(const Bitmap& other) {
    for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] &= ~other.bits_[i];
    return *this;
}

Outline Bitmap::trace() const {
    // Each set cell has directed edges counter-clockwise around it where its neighbour is not set, in a
    // bitmap for each direction (0: +x, 1: +y, 2: -x, 3: -y). An edge is named by its cell.
    std::array<Bitmap, 4> edges;
    for (Bitmap& e : edges) e = Bitmap(word0_, y0_, words_, rows_);
    for (int y = y0_; y < y0_ + rows_; ++y) {
        const std::uint64_t* here = row(y);
        for (int i = 0; i < words_; ++i) {
            if (here[i] == 0) continue;
            const std::uint64_t below = y > y0_ ? row(y - 1)[i] : 0;
            const std::uint64_t above = y + 1 < y0_ + rows_ ? row(y + 1)[i] : 0;
            const std::uint64_t left = here[i] << 1 | (i > 0 ? here[i - 1] >> 63 : 0);
            const std::uint64_t right = here[i] >> 1 | (i + 1 < words_ ? here[i + 1] << 63 : 0);
            edges[0].row(y)[i] = here[i] & ~below;
            edges[1].row(y)[i] = here[i] & ~right;
            edges[2].row(y)[i] = here[i] & ~above;
            edges[3].row(y)[i] = here[i] & ~left;
        }
    }
    // The cell whose edge in a direction starts at a corner, relative to the corner.
    constexpr std::array<int, 4> cell_x{0, -1, -1, 0}, cell_y{0, 0, -1, -1};
    constexpr std::array<int, 4> dx{1, 0, -1, 0}, dy{0, 1, 0, -1};
    const auto starts_at = [&](int direction, int x, int y) {
        const auto d = static_cast<std::size_t>(direction);
        return edges[d].at(x + cell_x[d], y + cell_y[d]);
    };
    const auto take = [&](int direction, int x, int y) {
        const auto d = static_cast<std::size_t>(direction);
        const int cx = x + cell_x[d];
        edges[d].row(y + cell_y[d])[(cx >> 6) - word0_] &= ~(std::uint64_t{1} << (cx & 63));
    };
    Outline outline;
    for (int y = y0_; y < y0_ + rows_; ++y) {
        for (int i = 0; i < words_; ++i) {
            // Every ring has edges along +x.
            while (const std::uint64_t left = edges[0].row(y)[i]) {
                const int start_x = 64 * (word0_ + i) + std::countr_zero(left);
                int cx = start_x, cy = y;
                int direction = 0, previous = -1;
                Ring ring;
                while (true) {
                    take(direction, cx, cy);
                    if (direction != previous) ring.emplace_back(cx, cy);
                    previous = direction;
                    cx += dx[static_cast<std::size_t>(direction)];
                    cy += dy[static_cast<std::size_t>(direction)];
                    // Turn left where two rings meet at a corner: cells that touch there stay apart.
                    const auto is_first = [&](int next) { return next == 0 && cx == start_x && cy == y; };
                    int next = (direction + 1) % 4;
                    while (!is_first(next) && !starts_at(next, cx, cy)) next = (next + 3) % 4;
                    if (is_first(next)) break;
                    direction = next;
                }
                if (previous == 0 && ring.size() > 1) ring.erase(ring.begin());  // the start was on an edge
                outline.rings.push_back(std::move(ring));
            }
        }
    }
    return outline;
}

}  // namespace planemap
