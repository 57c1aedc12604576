// SPDX-License-Identifier: BSD-3-Clause
// From planar cells to planar regions of whole cells.
#pragma once

#include <cstdint>
#include <vector>

#include "segmentation/cell_links.hpp"
#include "segmentation/cell_regions.hpp"
#include "segmentation/cells.hpp"
#include "segmentation/curvature.hpp"
#include "segmentation/merging.hpp"
#include "segmentation/point_sums.hpp"
#include "segmentation/touching.hpp"

namespace planemap::segmentation {

/// Grows regions of cells that share a plane.
class RegionGrower {
  public:
    explicit RegionGrower(const CellOptions& options);

    /// Finds regions of at least `min_pixels` pixels. Afterwards label_of_cell() holds 0 for none or
    /// i + 1 for planes()[i].
    void grow(const CellMap& map, double min_pixels);

    const std::vector<std::uint16_t>& label_of_cell() const { return result_.label_of_cell; }
    const std::vector<InverseDepthPlane>& planes() const { return planes_; }

  private:
    InverseDepthFit fit_around(const CellMap& map, int cell) const;
    void grow_from(const CellMap& map, int seed, double min_pixels);
    void settle_borders(const CellMap& map);
    /// Adds a cell to a region, or takes it away: sign 1 or -1.
    void move(const CellMap& map, int cell, std::uint16_t label, int sign);
    void merge(const CellMap& map);
    void keep_large(double min_pixels);

    CellOptions options_;
    CellLinks links_;
    SeedOrder seed_order_;
    ThinRegions thin_;
    CurvedRegions curved_;
    CellRegions result_;
    std::vector<int> queue_;
    std::vector<std::uint8_t> tried_;  // cells of a seed that came to nothing
    std::vector<Target> targets_;      // of the regions
    TouchList touching_;
    MergedLabels merged_;
    std::vector<int> order_;
    std::vector<std::uint16_t> new_label_;
    std::vector<InverseDepthPlane> planes_;
};

}  // namespace planemap::segmentation
