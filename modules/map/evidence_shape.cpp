// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_shape.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/bitmap.hpp"

namespace planemap::map {

namespace {

struct Shape {
    Bitmap cells, sure;
};

/// The cells of the shape, with room around them for what end_at() adds.
Shape shape_of(const EvidenceGrid& grid, int min_support) {
    constexpr int kSpare = 8;
    const int y0 = grid.y0(), words = grid.words(), rows = grid.rows();
    constexpr int kWellSupported = 8, kCertain = 12;  // support
    Bitmap shape(grid.word0() - 1, y0 - kSpare, words + 2, rows + 2 * kSpare);
    Bitmap sure = shape, possible = shape;
    for (int y = y0; y < y0 + rows; ++y) {
        const EvidenceCells* cells = grid.row(y);
        for (int w = 0; w < words; ++w) {
            const std::uint64_t present = cells[w].present();
            shape.row(y)[w + 1] = cells[w].supported(min_support) & present;
            sure.row(y)[w + 1] = cells[w].supported(kWellSupported) & present;
            possible.row(y)[w + 1] = ~cells[w].refuted();
        }
    }
    Bitmap solid = shape.closed(1);
    for (int y = y0; y < y0 + rows; ++y) {
        for (int w = 0; w < words; ++w) solid.row(y)[w + 1] &= possible.row(y)[w + 1];
    }
    Bitmap kept = solid.opened(1);
    sure &= shape;
    kept |= sure;
    for (int y = y0; y < y0 + rows; ++y)
        for (int w = 0; w < words; ++w) sure.row(y)[w + 1] = grid.row(y)[w].supported(kCertain);
    sure &= kept;
    return {std::move(kept), std::move(sure)};
}

Outline traced(const EvidenceGrid& grid, const OutlineOptions& options,
               const std::vector<MeetingLine>& lines) {
    if (grid.empty()) return {};
    const double cell_m = grid.cell_m();
    auto [cells, sure] = shape_of(grid, options.min_support);
    for (const MeetingLine& line : lines) end_at(line, cell_m, sure, cells);
    Outline outline = cells.trace();
    std::erase_if(outline.rings, [&](const Ring& ring) {
        return std::abs(signed_area(ring)) * cell_m * cell_m < options.min_ring_m2;
    });
    for (Ring& ring : outline.rings) {
        for (Eigen::Vector2d& vertex : ring) vertex *= cell_m;
    }
    return outline;
}

}  // namespace

Outline outline_of(const EvidenceGrid& grid, const OutlineOptions& options,
                   const std::vector<MeetingLine>& lines) {
    return with_straight_edges(traced(grid, options, lines), lines,
                               {grid.cell_m(), options.tolerance_m, options.least_m2});
}

Outline exact_outline_of(const EvidenceGrid& grid, const OutlineOptions& options) {
    return simplified(traced(grid, options, {}), std::min(grid.cell_m(), options.tolerance_m));
}

}  // namespace planemap::map
