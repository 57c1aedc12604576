// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace planemap::map {

/// Room for the words [word_from, word_to) of the rows [y_from, y_to).
void EvidenceGrid::grow(int word_from, int y_from, int word_to, int y_to) {
    if (!cells_.empty() && word_from >= word0_ && y_from >= y0_ && word_to <= word0_ + words_ &&
        y_to <= y0_ + rows_) {
        return;
    }
    int w0 = word_from, y0 = y_from, w1 = word_to, y1 = y_to;
    if (!cells_.empty()) {
        // Some rows to spare on the sides that grow, so that a plane explored slowly is not copied each time.
        const int spare = 8 + rows_ / 8;
        w0 = std::min(w0, word0_);
        w1 = std::max(w1, word0_ + words_);
        y0 = y_from < y0_ ? y_from - spare : y0_;
        y1 = y_to > y0_ + rows_ ? y_to + spare : y0_ + rows_;
    }
    std::vector<EvidenceCells> cells(static_cast<std::size_t>(w1 - w0) * static_cast<std::size_t>(y1 - y0));
    for (int y = y0_; y < y0_ + rows_; ++y) {
        std::copy(row(y), row(y) + words_,
                  cells.begin() + static_cast<std::ptrdiff_t>(y - y0) * (w1 - w0) + (word0_ - w0));
    }
    cells_ = std::move(cells);
    word0_ = w0, y0_ = y0, words_ = w1 - w0, rows_ = y1 - y0;
}

/// Draws a polygon into a bitmap of the words that it needs, and makes room for it.
void EvidenceGrid::draw(const FlatPolygon& polygon, Bitmap& inside) {
    Eigen::Vector2d low = polygon.vertices[0], high = low;
    for (const auto& v : polygon.vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    const double per_cell = 1 / cell_m_;
    const auto cell = [&](double metres) { return static_cast<int>(std::floor(metres * per_cell)); };
    const int y_from = cell(low.y()), y_to = cell(high.y()) + 1;
    const int word_from = cell(low.x()) >> 6, word_to = ((cell(high.x()) + 1) >> 6) + 1;
    grow(word_from, y_from, word_to, y_to);
    inside.reset(word_from, y_from, word_to - word_from, y_to - y_from);
    const Eigen::Vector2d first_centre(64.0 * word_from + 0.5, y_from + 0.5);
    inside.draw(polygon,
                [&](const Eigen::Vector2d& v) -> Eigen::Vector2d { return per_cell * v - first_centre; });
}

template <typename F>
void EvidenceGrid::for_each_word(const Bitmap& cells, const F& f) {
    for (int y = cells.y0(); y < cells.y0() + cells.rows(); ++y) {
        const std::uint64_t* bits = cells.row(y);
        EvidenceCells* evidence = row(y) + (cells.word0() - word0_);
        for (int w = 0; w < cells.words(); ++w)
            if (bits[w] != 0) f(bits[w], evidence[w]);
    }
}

int EvidenceGrid::add(const FlatPolygon& polygon, int strength, int looks, std::vector<Block>* fresh) {
    if (polygon.vertices.empty()) return 0;
    draw(polygon, inside_);
    if (fresh != nullptr) {
        const int word = inside_.word0() - word0_;
        const auto unseen = [&](int y, int w, const EvidenceCells& cells) {
            const bool is_inside = y >= inside_.y0() && y < inside_.y0() + inside_.rows();
            return is_inside ? inside_.row(y)[w - word] & ~cells.seen() : 0;
        };
        add_blocks(inside_.y0() & ~3, inside_.y0() + inside_.rows(), word, word + inside_.words(), unseen,
                   *fresh);
    }
    int came = 0;
    for_each_word(inside_, [&](std::uint64_t bits, EvidenceCells& cells) {
        const std::uint64_t before = cells.present();
        cells.add_support(bits, strength);
        cells.hit(bits, looks);
        came += std::popcount(cells.present() & ~before);
    });
    return came;
}

Bitmap EvidenceGrid::cells_of(const FlatPolygon& polygon) {
    Bitmap cells;
    if (!polygon.vertices.empty()) draw(polygon, cells);
    return cells;
}

void EvidenceGrid::add_support(const Bitmap& cells, int strength) {
    for_each_word(cells, [&](std::uint64_t bits, EvidenceCells& c) { c.add_support(bits, strength); });
}

void EvidenceGrid::hit_before(const Bitmap& cells, int looks) {
    for_each_word(cells, [&](std::uint64_t bits, EvidenceCells& c) { c.hit_before(bits, looks); });
}

void EvidenceGrid::forget_odds() {
    for (EvidenceCells& cells : cells_) cells.forget_odds();
}

void EvidenceGrid::settle_on(const EvidenceGrid& before) {
    for (int y = before.y0_; y < before.y0_ + before.rows_; ++y) {
        const EvidenceCells* theirs = before.row(y);
        EvidenceCells* ours = row(y) + (before.word0_ - word0_);
        for (int w = 0; w < before.words_; ++w) {
            if (theirs[w].seen() == 0) continue;
            for (int odds = 1; odds <= EvidenceCells::kMaxOdds; ++odds) {
                ours[w].hit_before(theirs[w].with_odds(odds), odds);
                ours[w].miss_before(theirs[w].with_odds(-odds), odds);
            }
        }
    }
    for (EvidenceCells& cells : cells_) cells.end_back_in_time();
}

void EvidenceGrid::add(const EvidenceGrid& other) {
    if (other.empty()) return;
    const Pose other_from_grid = other.world_from_grid_.inverse(Eigen::Isometry) * world_from_grid_;
    const Pose grid_from_other = other_from_grid.inverse(Eigen::Isometry);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    for (const int i : {0, 1, 2, 3}) {
        const double x = other.cell_m_ * (64.0 * (other.word0_ + (i & 1 ? other.words_ : 0)));
        const double y = other.cell_m_ * (other.y0_ + (i & 2 ? other.rows_ : 0));
        const Eigen::Vector2d corner = (grid_from_other * Eigen::Vector3d(x, y, 0)).head<2>();
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    const auto cell = [&](double metres) { return static_cast<int>(std::floor(metres / cell_m_)); };
    const int x_from = cell(low.x()), x_to = cell(high.x()) + 1;
    const int y_from = cell(low.y()), y_to = cell(high.y()) + 1;
    grow(x_from >> 6, y_from, ((x_to - 1) >> 6) + 1, y_to);
    const Eigen::Vector2d step = cell_m_ * other_from_grid.linear().col(0).head<2>();
    for (int y = y_from; y < y_to; ++y) {
        Eigen::Vector2d p =
            (other_from_grid * Eigen::Vector3d(cell_m_ * (x_from + 0.5), cell_m_ * (y + 0.5), 0)).head<2>();
        for (int x = x_from; x < x_to; ++x, p += step) {
            const Evidence theirs = other.evidence(p);
            if (theirs.support == 0) continue;
            EvidenceCells& here = row(y)[(x >> 6) - word0_];
            const int odds = here.odds(x & 63), support = here.support(x & 63);
            const std::uint64_t bit = std::uint64_t{1} << (x & 63);
            const int better = support == 0 ? theirs.odds : std::max(theirs.odds, odds);
            here.hit(bit, std::max(0, better - odds));
            here.miss(bit, std::max(0, odds - better));
            for (const int strength : {0, 1, 2, 3})
                if ((theirs.support >> strength & 1) != 0) here.add_support(bit, strength);
        }
    }
}

template <typename Select>
void EvidenceGrid::add_blocks(int first_row, int last_row, int first_word, int last_word,
                              const Select& select, std::vector<Block>& blocks) const {
    for (int y = first_row; y < last_row; y += 4) {
        for (int w = first_word; w < last_word; ++w) {
            std::array<std::uint64_t, 4> rows{};
            for (int r = std::max(y, y0_); r < std::min(y + 4, y0_ + rows_); ++r)
                rows[static_cast<std::size_t>(r - y)] = select(r, w, row(r)[w]);
            std::uint64_t any = rows[0] | rows[1] | rows[2] | rows[3];
            for (int nibble = 0; any != 0; ++nibble, any >>= 4) {
                if ((any & 15) == 0) continue;
                std::uint64_t cells = 0;
                for (std::size_t r = 0; r < 4; ++r) cells |= (rows[r] >> (4 * nibble) & 15) << (4 * r);
                const Eigen::Vector2d middle(cell_m_ * (64.0 * (word0_ + w) + 4.0 * nibble + 2.0),
                                             cell_m_ * (y + 2.0));
                blocks.push_back({middle, y, w, nibble, static_cast<std::uint16_t>(cells)});
            }
        }
    }
}

void EvidenceGrid::seen_blocks(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                               std::vector<Block>& blocks) const {
    // Blocks are aligned to the cells' coordinates, whatever part of them is looked at.
    const double per_cell = 1 / cell_m_;
    const auto within = [](double value, int from, int to) {
        return static_cast<int>(
            std::clamp(std::floor(value), static_cast<double>(from), static_cast<double>(to)));
    };
    const int first_row = within(low.y() * per_cell, y0_, y0_ + rows_) & ~3;
    const int last_row = within(high.y() * per_cell + 1, y0_, y0_ + rows_);
    const int first_word = within(low.x() * per_cell / 64, word0_, word0_ + words_) - word0_;
    const int last_word = within(high.x() * per_cell / 64 + 1, word0_, word0_ + words_) - word0_;
    const auto may_go = [](int, int, const EvidenceCells& cells) {
        return cells.seen() & ~cells.with_odds(EvidenceCells::kLeastOdds);
    };
    add_blocks(first_row, last_row, first_word, last_word, may_go, blocks);
}

template <typename F>
int EvidenceGrid::change(const Block& block, const F& f) {
    int lost = 0;
    for (int r = std::max(block.y, y0_); r < std::min(block.y + 4, y0_ + rows_); ++r) {
        EvidenceCells& c = row(r)[block.word];
        const std::uint64_t chosen = block.cells >> (4 * (r - block.y)) & 15;
        const std::uint64_t cells = c.seen() & chosen << (4 * block.nibble);
        const std::uint64_t before = c.present();
        f(c, cells);
        lost += std::popcount(before & ~c.present());
    }
    return lost;
}

int EvidenceGrid::miss(const Block& block, int looks) {
    return change(block, [&](EvidenceCells& c, std::uint64_t cells) { c.miss(cells, looks); });
}

int EvidenceGrid::miss_before(const Block& block, int looks) {
    return change(block, [&](EvidenceCells& c, std::uint64_t cells) { c.miss_before(cells, looks); });
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

EvidenceGrid::Evidence EvidenceGrid::evidence(const Eigen::Vector2d& p_grid) const {
    const double x = std::floor(p_grid.x() / cell_m_), y = std::floor(p_grid.y() / cell_m_);
    if (!(x >= 64.0 * word0_ && y >= y0_ && x < 64.0 * (word0_ + words_) && y < y0_ + rows_)) return {};
    const int cx = static_cast<int>(x);
    const EvidenceCells& cells = row(static_cast<int>(y))[(cx >> 6) - word0_];
    return {cells.support(cx & 63), cells.odds(cx & 63)};
}

}  // namespace planemap::map
