// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_regions.hpp"

#include <algorithm>

namespace planemap::segmentation {

void CellRegions::remove(std::uint16_t label) {
    std::replace(label_of_cell.begin(), label_of_cell.end(), label, std::uint16_t{0});
    at(label) = MergeRegion{};
}

void make_targets(const CellRegions& cell_regions, std::vector<Target>& targets) {
    targets.clear();
    for (const MergeRegion& region : cell_regions.regions) targets.emplace_back(region.fit.plane);
}

}  // namespace planemap::segmentation
