// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/geometry/outline_frame.hpp"
#include "map/evidence_blocks.hpp"

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
    const Eigen::AlignedBox2d box = bounds(polygon);
    const Eigen::Vector2d &low = box.min(), &high = box.max();
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

int EvidenceGrid::add(const FlatPolygon& polygon, int strength, int looks,
                      std::vector<EvidenceBlock>* fresh) {
    if (polygon.vertices.empty()) return 0;
    draw(polygon, inside_);
    if (fresh != nullptr) add_unseen_blocks(*this, inside_, *fresh);
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

EvidenceGrid::Evidence EvidenceGrid::evidence(const Eigen::Vector2d& p_grid) const {
    const double x = std::floor(p_grid.x() / cell_m_), y = std::floor(p_grid.y() / cell_m_);
    if (!(x >= 64.0 * word0_ && y >= y0_ && x < 64.0 * (word0_ + words_) && y < y0_ + rows_)) return {};
    const int cx = static_cast<int>(x);
    const EvidenceCells& cells = row(static_cast<int>(y))[(cx >> 6) - word0_];
    return {cells.support(cx & 63), cells.odds(cx & 63)};
}

}  // namespace planemap::map
