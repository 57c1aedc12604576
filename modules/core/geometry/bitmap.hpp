// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/outline.hpp"

namespace planemap {

/// A binary image of which 64 cells of a row are one word, so that what is done to cells is done to 64 of
/// them at once. Cells have integer coordinates of either sign; those outside are not set.
class Bitmap {
  public:
    Bitmap() = default;
    /// The words [word0, word0 + words) of the rows [y0, y0 + rows); bit i of word w is cell x = 64 w + i.
    Bitmap(int word0, int y0, int words, int rows)
        : word0_(word0),
          y0_(y0),
          words_(words),
          rows_(rows),
          bits_(static_cast<std::size_t>(words) * static_cast<std::size_t>(rows), 0) {}

    /// As made anew, in the same memory.
    void reset(int word0, int y0, int words, int rows) {
        word0_ = word0, y0_ = y0, words_ = words, rows_ = rows;
        bits_.assign(static_cast<std::size_t>(words) * static_cast<std::size_t>(rows), 0);
    }

    int word0() const { return word0_; }
    int y0() const { return y0_; }
    int words() const { return words_; }
    int rows() const { return rows_; }
    /// The words of a row inside.
    std::uint64_t* row(int y) { return bits_.data() + offset(y); }
    const std::uint64_t* row(int y) const { return bits_.data() + offset(y); }
    bool at(int x, int y) const {
        const int word = (x >> 6) - word0_;
        if (word < 0 || word >= words_ || y < y0_ || y >= y0_ + rows_) return false;
        return (row(y)[word] >> (x & 63) & 1) != 0;
    }
    /// Cells outside are left out.
    void set(int x, int y, bool value) {
        const int word = (x >> 6) - word0_;
        if (word < 0 || word >= words_ || y < y0_ || y >= y0_ + rows_) return;
        const std::uint64_t bit = std::uint64_t{1} << (x & 63);
        std::uint64_t& cells = row(y)[word];
        cells = value ? cells | bit : cells & ~bit;
    }
    std::size_t count() const;

    /// Sets the cells of which the centre lies inside the polygon (even-odd rule); what lies beside the
    /// bitmap is cut off. The bitmap must be empty before. from_first(vertex) is where a vertex lies from the
    /// centre of the bitmap's first cell, in cells.
    template <typename FromFirst>
    void draw(const FlatPolygon& polygon, const FromFirst& from_first) {
        for_each_edge(polygon, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
            flip_right_of(from_first(from), from_first(to));
        });
        set_between_flips();
    }

    /// Without parts narrower than 2 r + 1 cells (a square structuring element).
    Bitmap opened(int r) const;
    /// Gaps narrower than 2 r + 1 cells filled. The image must have r cells to spare at its border.
    Bitmap closed(int r) const;
    Bitmap& operator|=(const Bitmap& other);  ///< of the same cells
    Bitmap& operator&=(const Bitmap& other);  ///< of the same cells
    /// Without what is set in another one of the same cells.
    Bitmap& operator-=(const Bitmap& other);

    /// The boundary of the set cells as rings in cell corners: cell (x, y) is the square [x, x+1] x [y, y+1].
    /// Outer rings are counter-clockwise (x right, y up), holes clockwise; cells that touch at a corner only
    /// are separate parts. Collinear vertices are left out. Costs what the boundary is long.
    Outline trace() const;

  private:
    std::size_t offset(int y) const {
        return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(words_);
    }
    Bitmap widened_once(bool erode) const;
    void flip_right_of(Eigen::Vector2d a, Eigen::Vector2d b);
    void set_between_flips();

    int word0_ = 0, y0_ = 0, words_ = 0, rows_ = 0;
    std::vector<std::uint64_t> bits_;
};

}  // namespace planemap
