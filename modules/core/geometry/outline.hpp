// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

namespace planemap {

/// A closed polygon; the last vertex is joined to the first.
using Ring = std::vector<Eigen::Vector2d>;

/// The shape of a planar region: closed rings under the even-odd rule, so an inner ring is a hole and
/// separate parts are separate rings. Rings neither cross themselves nor each other. Coordinates are metres
/// in the x and y of the owner's box frame (see Box).
struct Outline {
    std::vector<Ring> rings;

    bool empty() const { return rings.empty(); }
    std::size_t vertex_count() const;
};

/// Calls edge(from, to) for every edge of the outline.
template <typename Edge>
void for_each_edge(const Outline& outline, const Edge& edge) {
    for (const Ring& ring : outline.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) edge(ring[j], ring[i]);
    }
}

/// Signed area by the shoelace formula: positive for counter-clockwise.
double signed_area(const Ring& ring);

/// Area under the even-odd rule; holes count as nothing. Square metres for an outline in metres.
double area(const Outline& outline);

/// True when the point is inside under the even-odd rule.
bool contains(const Outline& outline, const Eigen::Vector2d& p);

/// Distance from a point to the outline's area: 0 inside; infinity for an empty outline.
double distance(const Outline& outline, const Eigen::Vector2d& p);

/// Simplifies rings one after the other with the same buffers.
class RingSimplifier {
  public:
    struct Buffers {
        Ring path;
        std::vector<std::uint8_t> keep;
        std::vector<std::pair<std::size_t, std::size_t>> pending;
    };

    /// Douglas-Peucker in place; see simplified(). A ring that collapses is left empty.
    void simplify(Ring& ring, double tolerance);

  private:
    Buffers buffers_;
};

/// Douglas-Peucker on each ring: no vertex of the input is further than `tolerance` from the result. Rings
/// that collapse to fewer than three vertices are dropped.
Outline simplified(const Outline& outline, double tolerance);

/// The vertices of a ring that Douglas-Peucker keeps, ascending, of which those that are marked as fixed (one
/// flag a vertex) are some. Fewer than three for a ring that collapses.
std::vector<std::size_t> kept_vertices(const Ring& ring, const std::vector<std::uint8_t>& fixed,
                                       double tolerance);

/// A binary image, row-major, one byte a cell; non-zero is set.
struct Mask {
    int width = 0, height = 0;
    std::vector<std::uint8_t> cells;

    Mask() = default;
    Mask(int w, int h)
        : width(w), height(h), cells(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0) {}
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    bool at(int x, int y) const {
        return x >= 0 && y >= 0 && x < width && y < height && cells[index(x, y)] != 0;
    }
    void set(int x, int y) { cells[index(x, y)] = 1; }
};

/// Sets every cell of the mask whose centre lies inside the outline (given in cell-corner coordinates).
/// Parts outside the mask are clipped.
void fill(const Outline& outline, Mask& mask);

}  // namespace planemap
