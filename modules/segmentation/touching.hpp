// SPDX-License-Identifier: BSD-3-Clause
// What is decided between regions of cells that lie side by side.
#pragma once

#include <vector>

#include "segmentation/cell_links.hpp"
#include "segmentation/cell_regions.hpp"
#include "segmentation/merging.hpp"

namespace planemap::segmentation {

/// Pairs of regions with cells side by side, or with a few other cells between them.
void find_touching(const CellMap& map, const CellLinks& links, const CellRegions& cell_regions,
                   TouchList& touching);

/// Removes regions that are another one's noise along a border or a seam: chains of single cells beside a
/// region whose band holds them. Their pixels go to that region.
class ThinRegions {
  public:
    /// `band` says how far pixels may lie from their region's plane.
    void remove(const CellMap& map, const CellLinks& links, const BorderBand& band,
                CellRegions& cell_regions);

  private:
    void count_squares(const CellMap& map, const CellRegions& cell_regions);
    bool is_thin(const CellRegions& cell_regions, std::uint16_t label) const;

    std::vector<int> squares_;  // two by two cells, of each region
    TouchList touching_;
    MergedLabels separate_;
};

}  // namespace planemap::segmentation
