// SPDX-License-Identifier: BSD-3-Clause
// The cells of an EvidenceGrid in blocks of 4 x 4, as views are asked about them: where a block lies, how
// often it was asked about, and what looks that see past it do to it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "map/evidence_grid.hpp"

namespace planemap::map {

/// 4 x 4 cells of a grid, of which some count. Blocks are aligned to the cells' coordinates.
struct EvidenceBlock {
    Eigen::Vector2d middle;        ///< metres in the grid's x, y
    int y, word, nibble;           ///< first row, word in a row of the grid, which four bits of it
    std::uint16_t cells = 0xffff;  ///< of the block that count: four bits a row
    std::uint16_t asked = 0;       ///< views, by who asks them
    std::uint16_t missed = 0;      ///< looks that saw past it, of these
};

/// Adds the blocks between low and high (metres in the grid's x, y) to the list that have cells which were
/// seen and may still go further down, row after row.
void add_seen_blocks(const EvidenceGrid& grid, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                     std::vector<EvidenceBlock>& blocks);
/// Adds the blocks that have some of these cells which were never seen, row after row. The grid has room for
/// them: see EvidenceGrid::cells_of().
void add_unseen_blocks(const EvidenceGrid& grid, const Bitmap& cells, std::vector<EvidenceBlock>& blocks);

/// That looks saw past a block, after all others or before them; returns how many cells left the shape. The
/// block is one of this grid as it lies now: a grid that has grown since numbers its words anew.
int miss(EvidenceGrid& grid, const EvidenceBlock& block, int looks);
int miss_before(EvidenceGrid& grid, const EvidenceBlock& block, int looks);

/// Whether a bitmap of the grid's cells has some in a block, or so many cells beside it.
bool is_near(const EvidenceGrid& grid, const Bitmap& cells, const EvidenceBlock& block, int beside);
/// Whether looks before all others may say something of a block.
bool is_undecided(const EvidenceGrid& grid, const EvidenceBlock& block);

}  // namespace planemap::map
