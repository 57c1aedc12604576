// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_grid.hpp"

#include <algorithm>
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

int EvidenceGrid::add(const FlatPolygon& polygon, int strength) {
    if (polygon.vertices.empty()) return 0;
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

    inside_.reset(word_from, y_from, word_to - word_from, y_to - y_from);
    const Eigen::Vector2d first_centre(64.0 * word_from + 0.5, y_from + 0.5);
    inside_.draw(polygon,
                 [&](const Eigen::Vector2d& v) -> Eigen::Vector2d { return per_cell * v - first_centre; });
    int fresh = 0;
    for (int y = y_from; y < y_to; ++y) {
        const std::uint64_t* inside = inside_.row(y);
        EvidenceCells* cells = row(y) + (word_from - word0_);
        for (int w = 0; w < inside_.words(); ++w) {
            if (inside[w] == 0) continue;
            fresh += std::popcount(inside[w] & ~cells[w].at_least(1));
            cells[w].add_hits(inside[w], strength);
        }
    }
    return fresh;
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
            const Counts theirs = other.counts(p);
            if (theirs.hits == 0 && theirs.misses == 0) continue;
            EvidenceCells& here = row(y)[(x >> 6) - word0_];
            const std::uint64_t bit = std::uint64_t{1} << (x & 63);
            for (const int strength : {0, 1, 2, 3}) {
                if ((theirs.hits >> strength & 1) != 0) here.add_hits(bit, strength);
                if ((theirs.misses >> strength & 1) != 0) here.add_misses(bit, strength);
            }
        }
    }
}

void EvidenceGrid::uncertain_blocks(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
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
    for (int y = first_row; y < last_row; y += 4) {
        for (int w = first_word; w < last_word; ++w) {
            std::uint64_t any = 0;
            for (int r = std::max(y, y0_); r < std::min(y + 4, y0_ + rows_); ++r)
                any |= row(r)[w].uncertain();
            for (int nibble = 0; any != 0; ++nibble, any >>= 4) {
                if ((any & 15) == 0) continue;
                blocks.push_back({{cell_m_ * (64.0 * (word0_ + w) + 4.0 * nibble + 2.0), cell_m_ * (y + 2.0)},
                                  y,
                                  w,
                                  nibble});
            }
        }
    }
}

int EvidenceGrid::add_misses(const Block& block, int strength) {
    int lost = 0;
    for (int r = std::max(block.y, y0_); r < std::min(block.y + 4, y0_ + rows_); ++r) {
        EvidenceCells& c = row(r)[block.word];
        const std::uint64_t cells = c.uncertain() & std::uint64_t{15} << (4 * block.nibble);
        c.add_misses(cells, strength);
        lost += std::popcount(cells & c.refuted());
    }
    return lost;
}

EvidenceGrid::Counts EvidenceGrid::counts(const Eigen::Vector2d& p_grid) const {
    const double x = std::floor(p_grid.x() / cell_m_), y = std::floor(p_grid.y() / cell_m_);
    if (!(x >= 64.0 * word0_ && y >= y0_ && x < 64.0 * (word0_ + words_) && y < y0_ + rows_)) return {};
    const int cx = static_cast<int>(x);
    const EvidenceCells& cells = row(static_cast<int>(y))[(cx >> 6) - word0_];
    return {cells.hits(cx & 63), cells.misses(cx & 63)};
}

/// The cells of the shape, with room around them for what end_at() adds.
EvidenceGrid::Shape EvidenceGrid::shape(int min_hits) const {
    constexpr int kSpare = 8;
    constexpr int kWellSupported = 8;
    Bitmap shape(word0_ - 1, y0_ - kSpare, words_ + 2, rows_ + 2 * kSpare);
    Bitmap sure = shape, refuted = shape;
    for (int y = y0_; y < y0_ + rows_; ++y) {
        const EvidenceCells* cells = row(y);
        for (int w = 0; w < words_; ++w) {
            const std::uint64_t against = cells[w].refuted();
            shape.row(y)[w + 1] = cells[w].at_least(min_hits) & ~against;
            sure.row(y)[w + 1] = cells[w].at_least(kWellSupported) & ~against;
            refuted.row(y)[w + 1] = ~against;
        }
    }
    Bitmap solid = shape.closed(1);
    for (int y = y0_; y < y0_ + rows_; ++y) {
        for (int w = 0; w < words_; ++w) solid.row(y)[w + 1] &= refuted.row(y)[w + 1];
    }
    Bitmap kept = solid.opened(1);
    sure &= shape;
    kept |= sure;
    for (int y = y0_; y < y0_ + rows_; ++y)
        for (int w = 0; w < words_; ++w) sure.row(y)[w + 1] = row(y)[w].at_least(EvidenceCells::kCertain);
    sure &= kept;
    return {std::move(kept), std::move(sure)};
}

Outline EvidenceGrid::outline(const OutlineOptions& options, const std::vector<MeetingLine>& lines) const {
    if (cells_.empty()) return {};
    auto [cells, sure] = shape(options.min_hits);
    for (const MeetingLine& line : lines) end_at(line, cell_m_, sure, cells);
    Outline outline = cells.trace();
    std::erase_if(outline.rings, [&](const Ring& ring) {
        return std::abs(signed_area(ring)) * cell_m_ * cell_m_ < options.min_ring_m2;
    });
    for (Ring& ring : outline.rings) {
        for (Eigen::Vector2d& vertex : ring) vertex *= cell_m_;
    }
    return with_straight_edges(outline, lines, {cell_m_, options.tolerance_m, options.least_m2});
}

}  // namespace planemap::map
