// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/pose.hpp"
#include "map/evidence_cells.hpp"

namespace planemap::map {

struct EvidenceBlock;

/// Where a plane has been seen and where something beyond it was: a raster in the plane that knows both for
/// each cell (EvidenceCells), 64 cells at once. It grows with the plane's extent and not with the number of
/// observations. Cells are aligned to the origin of the grid's frame.
class EvidenceGrid {
  public:
    EvidenceGrid() = default;
    /// An empty grid; x and y of the frame lie in the plane, z is its normal.
    EvidenceGrid(const Pose& world_from_grid, double cell_m)
        : world_from_grid_(world_from_grid), cell_m_(cell_m) {}

    const Pose& world_from_grid() const { return world_from_grid_; }
    double cell_m() const { return cell_m_; }
    bool empty() const { return cells_.empty(); }
    std::size_t memory_bytes() const { return cells_.capacity() * sizeof(EvidenceCells); }

    /// What `looks` looks saw after all others: the cells whose centre lies inside the polygon (metres in the
    /// grid's x, y), with a support of 2^strength (strength 0 to 2). Returns how many cells came to the
    /// shape; adds blocks of the cells that were never seen before to `fresh`, row after row.
    int add(const FlatPolygon& polygon, int strength, int looks = 1,
            std::vector<EvidenceBlock>* fresh = nullptr);
    /// The cells of a polygon, for which the grid makes room.
    Bitmap cells_of(const FlatPolygon& polygon);
    void add_support(const Bitmap& cells, int strength);
    /// Looks before all others, see EvidenceCells.
    void hit_before(const Bitmap& cells, int looks);
    void forget_odds();
    /// Takes another grid's odds for what was before all looks; of the same frame, and no larger.
    void settle_on(const EvidenceGrid& before);
    /// Adds another grid, resampled to this one's cells: of support the sum, of odds the better ones.
    void add(const EvidenceGrid& other);

    struct Evidence {
        int support = 0, odds = 0;
    };
    /// Of the cell that holds a point (metres in the grid's x, y).
    Evidence evidence(const Eigen::Vector2d& p_grid) const;

    /// The stored cells, for who reads shapes off them or lets some go (map/evidence_blocks): words() words
    /// in each of rows() rows from y0(); word w of a row holds the cells x = 64 (word0() + w) to 64 (word0()
    /// + w) + 63.
    int word0() const { return word0_; }
    int y0() const { return y0_; }
    int words() const { return words_; }
    int rows() const { return rows_; }
    const EvidenceCells* row(int y) const {
        return cells_.data() + static_cast<std::ptrdiff_t>(y - y0_) * words_;
    }
    EvidenceCells* row(int y) { return cells_.data() + static_cast<std::ptrdiff_t>(y - y0_) * words_; }

  private:
    void grow(int word_from, int y_from, int word_to, int y_to);
    void draw(const FlatPolygon& polygon, Bitmap& inside);
    /// f(word of the bitmap, cells of the grid) where the bitmap has any.
    template <typename F>
    void for_each_word(const Bitmap& cells, const F& f);

    Pose world_from_grid_ = Pose::Identity();
    double cell_m_ = 0.025;
    int word0_ = 0, y0_ = 0, words_ = 0, rows_ = 0;  ///< stored: word w holds the cells x = 64 w to 64 w + 63
    std::vector<EvidenceCells> cells_;
    Bitmap inside_;  ///< scratch of add()
};

}  // namespace planemap::map
