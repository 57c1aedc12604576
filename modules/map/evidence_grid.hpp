// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/outline.hpp"
#include "core/geometry/pose.hpp"
#include "map/edges.hpp"
#include "map/evidence_cells.hpp"

namespace planemap::map {

/// How a plane's shape is read off its evidence.
struct OutlineOptions {
    int min_hits = 1;           ///< evidence a cell needs to be part of the shape, 1 to 15
    double min_ring_m2 = 0.01;  ///< smaller parts and smaller holes are left out
    double tolerance_m =
        0.03;             ///< no traced vertex is further than this from the simplified outline, but for
    double least_m2 = 0;  ///< teeth and notches whose corners enclose less, see EdgeRules
};

/// Where a plane has been seen (hits) and where something beyond it was (misses): a raster in the plane that
/// counts both for each cell, 64 cells at once. It grows with the plane's extent and not with the number of
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

    /// Adds 2^strength hits (strength 0 to 2) to every cell whose centre lies inside the polygon (metres in
    /// the grid's x, y). Returns how many cells were hit for the first time.
    int add(const FlatPolygon& polygon_grid, int strength);
    /// Adds another grid's counts, resampled to this one's cells.
    void add(const EvidenceGrid& other);

    /// Counts of the cell that holds a point (metres in the grid's x, y).
    struct Counts {
        int hits = 0, misses = 0;
    };
    Counts counts(const Eigen::Vector2d& p_grid) const;

    /// 4 x 4 cells of which some are uncertain (EvidenceCells::uncertain()).
    struct Block {
        Eigen::Vector2d middle;  ///< metres in the grid's x, y
        int y, word, nibble;     ///< first row, word in a row, which four bits of it
    };
    /// Adds those between low and high to the list.
    void uncertain_blocks(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                          std::vector<Block>& blocks) const;
    /// Adds 2^strength misses to the uncertain cells of a block; returns how many cells left the shape by it.
    int add_misses(const Block& block, int strength);

    /// The shape: cells with enough hits and no more misses than hits; slits of up to two cells closed,
    /// slivers of up to two cells left out unless they are well supported. Metres in the grid's x and y; its
    /// rings do not cross.
    /// It ends at the lines where other planes meet it, if it comes within their reach: see end_at().
    Outline outline(const OutlineOptions& options, const std::vector<MeetingLine>& lines = {}) const;

  private:
    struct Shape {
        Bitmap cells, sure;
    };
    Shape shape(int min_hits) const;
    void grow(int word_from, int y_from, int word_to, int y_to);
    EvidenceCells* row(int y) { return cells_.data() + static_cast<std::ptrdiff_t>(y - y0_) * words_; }
    const EvidenceCells* row(int y) const {
        return cells_.data() + static_cast<std::ptrdiff_t>(y - y0_) * words_;
    }

    Pose world_from_grid_ = Pose::Identity();
    double cell_m_ = 0.025;
    int word0_ = 0, y0_ = 0, words_ = 0, rows_ = 0;  ///< stored: word w holds the cells x = 64 w to 64 w + 63
    std::vector<EvidenceCells> cells_;
    Bitmap inside_;  ///< scratch of add()
};

}  // namespace planemap::map
