// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_blocks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace planemap::map {

namespace {

/// Rows, and words in them, of a grid; one past the last ones.
struct GridPart {
    int row_from, row_to, word_from, word_to;
};

/// Adds blocks of the cells that select(row, word, cells of the grid) picks in a part of it.
template <typename Select>
void add_blocks(const EvidenceGrid& grid, const GridPart& part, const Select& select,
                std::vector<EvidenceBlock>& blocks) {
    const int first = grid.y0(), end = grid.y0() + grid.rows();
    for (int y = part.row_from; y < part.row_to; y += 4) {
        for (int w = part.word_from; w < part.word_to; ++w) {
            std::array<std::uint64_t, 4> rows{};
            for (int r = std::max(y, first); r < std::min(y + 4, end); ++r)
                rows[static_cast<std::size_t>(r - y)] = select(r, w, grid.row(r)[w]);
            std::uint64_t any = rows[0] | rows[1] | rows[2] | rows[3];
            for (int nibble = 0; any != 0; ++nibble, any >>= 4) {
                if ((any & 15) == 0) continue;
                std::uint64_t cells = 0;
                for (std::size_t r = 0; r < 4; ++r) cells |= (rows[r] >> (4 * nibble) & 15) << (4 * r);
                const Eigen::Vector2d middle(grid.cell_m() * (64.0 * (grid.word0() + w) + 4.0 * nibble + 2.0),
                                             grid.cell_m() * (y + 2.0));
                blocks.push_back({middle, y, w, nibble, static_cast<std::uint16_t>(cells)});
            }
        }
    }
}

/// f(cells of the grid, bits) for each row of a block; returns how many left the shape by that.
template <typename F>
int change(EvidenceGrid& grid, const EvidenceBlock& block, const F& f) {
    int lost = 0;
    const int end = std::min(block.y + 4, grid.y0() + grid.rows());
    for (int r = std::max(block.y, grid.y0()); r < end; ++r) {
        EvidenceCells& c = grid.row(r)[block.word];
        const std::uint64_t chosen = block.cells >> (4 * (r - block.y)) & 15;
        const std::uint64_t cells = c.seen() & chosen << (4 * block.nibble);
        const std::uint64_t before = c.present();
        f(c, cells);
        lost += std::popcount(before & ~c.present());
    }
    return lost;
}

}  // namespace

void add_seen_blocks(const EvidenceGrid& grid, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                     std::vector<EvidenceBlock>& blocks) {
    const double per_cell = 1 / grid.cell_m();
    const auto within = [](double value, int from, int to) {
        return static_cast<int>(
            std::clamp(std::floor(value), static_cast<double>(from), static_cast<double>(to)));
    };
    const int y0 = grid.y0(), y1 = y0 + grid.rows(), word0 = grid.word0(), word1 = word0 + grid.words();
    // Whatever part of a block is looked at, it is a whole one.
    const GridPart part{within(low.y() * per_cell, y0, y1) & ~3, within(high.y() * per_cell + 1, y0, y1),
                        within(low.x() * per_cell / 64, word0, word1) - word0,
                        within(high.x() * per_cell / 64 + 1, word0, word1) - word0};
    const auto may_go = [](int, int, const EvidenceCells& cells) {
        return cells.seen() & ~cells.with_odds(EvidenceCells::kLeastOdds);
    };
    add_blocks(grid, part, may_go, blocks);
}

void add_unseen_blocks(const EvidenceGrid& grid, const Bitmap& cells, std::vector<EvidenceBlock>& blocks) {
    const int word = cells.word0() - grid.word0(), y0 = cells.y0(), y1 = y0 + cells.rows();
    const auto unseen = [&](int y, int w, const EvidenceCells& evidence) {
        return y >= y0 && y < y1 ? cells.row(y)[w - word] & ~evidence.seen() : 0;
    };
    add_blocks(grid, {y0 & ~3, y1, word, word + cells.words()}, unseen, blocks);
}

int miss(EvidenceGrid& grid, const EvidenceBlock& block, int looks) {
    return change(grid, block, [&](EvidenceCells& c, std::uint64_t cells) { c.miss(cells, looks); });
}

int miss_before(EvidenceGrid& grid, const EvidenceBlock& block, int looks) {
    return change(grid, block, [&](EvidenceCells& c, std::uint64_t cells) { c.miss_before(cells, looks); });
}

bool is_near(const EvidenceGrid& grid, const Bitmap& cells, const EvidenceBlock& block, int beside) {
    const int first_row = std::max(block.y - beside, cells.y0());
    const int last_row = std::min(block.y + 4 + beside, cells.y0() + cells.rows());
    // The block's bits, and those beside them, as far as they lie in the words before and after.
    const int word = block.word + grid.word0() - cells.word0(), first = 4 * block.nibble;
    const std::uint64_t four = std::uint64_t{15} << first;
    std::uint64_t here = four;
    for (int i = 1; i <= beside; ++i) here |= four << i | four >> i;
    const std::uint64_t after =
        first + 4 + beside > 64 ? (std::uint64_t{1} << (first + 4 + beside - 64)) - 1 : 0;
    const std::uint64_t before = first < beside ? ~std::uint64_t{0} << (64 + first - beside) : 0;
    const std::array<std::uint64_t, 3> masks{before, here, after};
    for (int r = first_row; r < last_row; ++r) {
        for (int w = 0; w < 3; ++w) {
            const int at = word - 1 + w;
            if (at >= 0 && at < cells.words() && (cells.row(r)[at] & masks[static_cast<std::size_t>(w)]) != 0)
                return true;
        }
    }
    return false;
}

bool is_undecided(const EvidenceGrid& grid, const EvidenceBlock& block) {
    std::uint64_t cells = 0;
    const int last = std::min(block.y + 4, grid.y0() + grid.rows());
    for (int r = std::max(block.y, grid.y0()); r < last; ++r) {
        const EvidenceCells& c = grid.row(r)[block.word];
        cells |= c.seen() & ~c.decided();
    }
    return (cells >> (4 * block.nibble) & 15) != 0;
}

}  // namespace planemap::map
