// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/region_sums.hpp"

#include <algorithm>
#include <array>

namespace planemap::segmentation {

namespace {

/// Adds the sums as they would be without noise, weighted by its variance. Inverse depth is what has
/// symmetric errors, so that its reciprocal z is too large in the mean by `relative2` = (sigma / z)^2, and
/// z^2 by three times that.
void add_unbiased(PointSums& to, PointSums part, double relative2) {
    const double first = 1 - relative2, second = 1 - 3 * relative2;
    for (double* sum : {&part.x, &part.y, &part.z}) *sum *= first;
    for (double* sum : {&part.xx, &part.xy, &part.xz, &part.yy, &part.yz, &part.zz}) *sum *= second;
    to.add(1 / relative2, part);
}

}  // namespace

void RegionSummer::add_sums(const DepthNoise& noise, std::uint16_t label, const PointSums& part, int cells) {
    const double z = part.zz / part.z, sigma = std::min(std::max(1e-6, noise.sigma(z)), 0.1 * z);
    RegionSums& region = region_sums_[label - 1];
    region.points += part;
    region.cells += cells;
    add_unbiased(region.weighted, part, sigma * sigma / (z * z));
}

void RegionSummer::sum_waiting(const CellGrid& grid, const DepthNoise& noise) {
    std::array<PointSums, 8> sums;
    grid.sum(waiting_, sums.data());
    for (std::size_t k = 0; k < waiting_.size(); ++k) add_sums(noise, waiting_[k].label, sums[k], 1);
    waiting_.clear();
}

std::vector<RegionSums>& RegionSummer::sum(const CellGrid& grid, const PixelLabeller& labeller,
                                           const DepthNoise& noise) {
    region_sums_.assign(labeller.candidates().size(), {});
    waiting_.clear();
    // Whole cells in a row are weighted together, a few at a time so that their depth hardly differs.
    constexpr int kRun = 4;
    struct Run {
        PointSums sums;
        std::uint16_t label = 0;
        int cells = 0;
    } run;
    const auto end_run = [&] {
        if (run.cells > 0) add_sums(noise, run.label, run.sums, run.cells);
        run = {};
    };
    for (int i = 0; i < grid.size(); ++i) {
        const CellLabels& list = labeller.cell_labels()[i];
        const PointSums& whole = grid.sums()[i];
        for (std::size_t k = 0; k < list.size; ++k) {
            if (list.pixels[k] == 0) continue;
            if (list.pixels[k] == whole.n) {
                if (run.label != list.label[k] || run.cells == kRun) end_run();
                run.label = list.label[k];
                run.sums += whole;
                ++run.cells;
                continue;
            }
            const CellGrid::Place place = grid.place(i);
            waiting_.push_back(
                {place, list.label[k], grid.depth_at(place, labeller.candidates()[list.label[k] - 1])});
            if (waiting_.size() == 8) sum_waiting(grid, noise);
        }
    }
    end_run();
    if (!waiting_.empty()) sum_waiting(grid, noise);
    return region_sums_;
}

}  // namespace planemap::segmentation
