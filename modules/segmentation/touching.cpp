// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/touching.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::segmentation {

void find_touching(const CellMap& map, const CellLinks& links, const CellRegions& cell_regions,
                   TouchList& touching) {
    constexpr int kGap = 4;  // other cells between two regions
    const std::vector<std::uint16_t>& label_of_cell = cell_regions.label_of_cell;
    touching.clear();
    const auto look = [&](int from, int steps, int stride, int k) {
        const std::uint16_t a = label_of_cell[from];
        for (int step = 1; step <= steps; ++step) {
            const std::uint16_t b = label_of_cell[from + step * stride];
            if (b == a) return;
            if (b == 0) continue;
            touching.add(a, b, step == 1 && links.linked(from, k), step == 1);
            return;
        }
    };
    for (int y = 0, i = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.columns; ++x, ++i) {
            const std::uint16_t label = label_of_cell[i];
            if (label == 0) continue;
            if (x + 1 < map.columns && label_of_cell[i + 1] != label)
                look(i, std::min(kGap + 1, map.columns - 1 - x), 1, 0);
            if (y + 1 < map.rows && label_of_cell[i + map.columns] != label)
                look(i, std::min(kGap + 1, map.rows - 1 - y), map.columns, 1);
        }
    }
}

void ThinRegions::count_squares(const CellMap& map, const CellRegions& cell_regions) {
    squares_.assign(cell_regions.regions.size(), 0);
    for (int y = 0; y + 1 < map.rows; ++y) {
        const std::uint16_t *row = cell_regions.label_of_cell.data() +
                                   static_cast<std::ptrdiff_t>(y) * map.columns,
                            *below = row + map.columns;
        for (int x = 0; x + 1 < map.columns; ++x) {
            if (row[x] != 0 && row[x] == row[x + 1] && row[x] == below[x] && row[x] == below[x + 1])
                ++squares_[row[x] - 1u];
        }
    }
}

bool ThinRegions::is_thin(const CellRegions& cell_regions, std::uint16_t label) const {
    constexpr int kCellsPerSquare = 16;  // chains have few squares
    return squares_[label - 1u] * kCellsPerSquare < cell_regions.at(label).cells;
}

void ThinRegions::remove(const CellMap& map, const CellLinks& links, const BorderBand& band,
                         CellRegions& cell_regions) {
    count_squares(map, cell_regions);
    find_touching(map, links, cell_regions, touching_);
    separate_.reset(cell_regions.regions.size() + 1);  // cells have the labels of what was merged
    touching_.gather(separate_);
    for (const Touch& touch : touching_.entries()) {
        const bool first =
            is_thin(cell_regions, touch.a) && cell_regions.at(touch.a).cells < cell_regions.at(touch.b).cells;
        if (!first && !is_thin(cell_regions, touch.b)) continue;
        const std::uint16_t thin = first ? touch.a : touch.b, other = first ? touch.b : touch.a;
        const MergeRegion &strip = cell_regions.at(thin), &beside = cell_regions.at(other);
        if (strip.cells == 0 || beside.cells < strip.cells) continue;
        const double z = 1 / strip.fit.w;
        const double width = std::max(band.thickness_m, band.thickness_sigmas * band.noise.sigma(z));
        const double rms = std::sqrt(strip.fit.mse_to(beside.fit.plane));
        if (distance_of(rms, z, beside.fit.plane) < 0.5 * width) cell_regions.remove(thin);
    }
}

}  // namespace planemap::segmentation
