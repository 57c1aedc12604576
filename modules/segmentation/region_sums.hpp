// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "segmentation/cell_grid.hpp"
#include "segmentation/pixel_labels.hpp"
#include "segmentation/point_sums.hpp"

namespace planemap::segmentation {

/// What a region's pixels add up to.
struct RegionSums {
    PointSums points;    ///< unweighted
    PointSums weighted;  ///< by the noise
    int cells = 0;
};

/// Adds up the labelled pixels of each region.
class RegionSummer {
  public:
    /// Sums of the regions that `labeller` labelled in the grid. The caller may join them.
    std::vector<RegionSums>& sum(const CellGrid& grid, const PixelLabeller& labeller,
                                 const DepthNoise& noise);

  private:
    void sum_waiting(const CellGrid& grid, const DepthNoise& noise);
    void add_sums(const DepthNoise& noise, std::uint16_t label, const PointSums& part, int cells);

    std::vector<CellGrid::Part> waiting_;  // to be summed
    std::vector<RegionSums> region_sums_;
};

}  // namespace planemap::segmentation
