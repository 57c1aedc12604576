// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/pose.hpp"
#include "map/evidence_cells.hpp"

namespace planemap::map {

/// 4 x 4 cells of a grid, of which some count.
struct EvidenceBlock {
    Eigen::Vector2d middle;        ///< metres in the grid's x, y
    int y, word, nibble;           ///< first row, word in a row of the grid, which four bits of it
    std::uint16_t cells = 0xffff;  ///< of the block that count: four bits a row
    std::uint16_t asked = 0;       ///< views, by who asks them
    std::uint16_t missed = 0;      ///< looks that saw past it, of these
};

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

    using Block = EvidenceBlock;

    /// What `looks` looks saw after all others: the cells whose centre lies inside the polygon (metres in the
    /// grid's x, y), with a support of 2^strength (strength 0 to 2). Returns how many cells came to the
    /// shape; adds blocks of the cells that were never seen before to `fresh`, row after row.
    int add(const FlatPolygon& polygon, int strength, int looks = 1, std::vector<Block>* fresh = nullptr);
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

    /// Adds the blocks between low and high to the list that have cells which were seen and may still go
    /// further down, row after row.
    void seen_blocks(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                     std::vector<Block>& blocks) const;
    /// That looks saw past a block, after all others or before them; returns how many cells left the shape.
    int miss(const Block& block, int looks);
    int miss_before(const Block& block, int looks);

    /// The stored cells, for who reads shapes off them: words() words in each of rows() rows from y0(); word
    /// w of a row holds the cells x = 64 (word0() + w) to 64 (word0() + w) + 63.
    int word0() const { return word0_; }
    int y0() const { return y0_; }
    int words() const { return words_; }
    int rows() const { return rows_; }
    const EvidenceCells* row(int y) const {
        return cells_.data() + static_cast<std::ptrdiff_t>(y - y0_) * words_;
    }

  private:
    void grow(int word_from, int y_from, int word_to, int y_to);
    EvidenceCells* row(int y) { return cells_.data() + static_cast<std::ptrdiff_t>(y - y0_) * words_; }
    void draw(const FlatPolygon& polygon, Bitmap& inside);
    /// f(word of the bitmap, cells of the grid) where the bitmap has any.
    template <typename F>
    void for_each_word(const Bitmap& cells, const F& f);
    /// f(cells of the grid, bits) for each row of a block, and what left the shape by that.
    template <typename F>
    int change(const Block& block, const F& f);
    /// Adds blocks of the cells that select(cells of the grid) picks, between rows and words.
    template <typename Select>
    void add_blocks(int first_row, int last_row, int first_word, int last_word, const Select& select,
                    std::vector<Block>& blocks) const;

    Pose world_from_grid_ = Pose::Identity();
    double cell_m_ = 0.025;
    int word0_ = 0, y0_ = 0, words_ = 0, rows_ = 0;  ///< stored: word w holds the cells x = 64 w to 64 w + 63
    std::vector<EvidenceCells> cells_;
    Bitmap inside_;  ///< scratch of add()
};

/// Whether a bitmap of the grid's cells has some in a block, or so many cells beside it.
bool is_near(const EvidenceGrid& grid, const Bitmap& cells, const EvidenceBlock& block, int beside);
/// Whether looks before all others may say something of a block.
bool is_undecided(const EvidenceGrid& grid, const EvidenceBlock& block);

}  // namespace planemap::map
