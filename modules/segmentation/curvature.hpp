// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "segmentation/cell_links.hpp"
#include "segmentation/cell_regions.hpp"

namespace planemap::segmentation {

/// Tells planes from flat pieces of curved surfaces.
class CurvedRegions {
  public:
    /// A region that turns by more than bend_rad from end to end is curved. Cells whose normals differ by
    /// less than grow_angle_rad may be one surface.
    CurvedRegions(double bend_rad, double grow_angle_rad)
        : bend_rad_(bend_rad), grow_angle_rad_(grow_angle_rad) {}

    /// Removes the regions that are curved.
    void remove(const CellMap& map, const CellLinks& links, CellRegions& cell_regions);

  private:
    /// How a region departs from its plane.
    struct Bend {
        double turn = 0;       // of the normal from end to end, radians
        double rise = 0;       // of the middle over the ends, metres
        double explained = 0;  // share of the cells' squared distances that it accounts for
    };
    /// Edges of a region's cells that lead out of it.
    struct Border {
        int length = 0, smooth = 0;
    };

    void find_smooth_borders(const CellMap& map, const CellLinks& links, const CellRegions& cell_regions);
    void gather_members(const CellRegions& cell_regions);
    Bend bend_of(const CellMap& map, const MergeRegion& region, std::uint16_t label) const;
    bool is_curved(const CellMap& map, const MergeRegion& region, std::uint16_t label) const;

    double bend_rad_, grow_angle_rad_;
    std::vector<Target> targets_;       // of the regions
    std::vector<Border> borders_;       // of the regions
    std::vector<int> members_, first_;  // cells by region; where each region's begin
};

}  // namespace planemap::segmentation
