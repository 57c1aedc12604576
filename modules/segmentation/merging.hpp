// SPDX-License-Identifier: BSD-3-Clause
// Joins regions that are parts of one plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/union_find.hpp"
#include "segmentation/point_sums.hpp"

namespace planemap::segmentation {

/// When two regions are one; see CellOptions.
struct MergeRules {
    double merge_m = 0, merge_sigmas = 0, angle_rad = 0;
    double cell_x = 0;  ///< width of a cell in normalised coordinates
    DepthNoise noise;   ///< of the sensor
};

/// A region of cells. Its sums are weighted such that the mean squared residual of inverse depth is what
/// fit() gives.
struct MergeRegion {
    PointSums sums;
    InverseDepthFit fit;
    double pixels = 0;
    int cells = 0;
};

/// Labels of regions that are one; the least label of them is its name. Label i + 1 is regions[i], 0 is none.
using MergedLabels = UnionFind<std::uint16_t>;

/// Two regions that lie side by side somewhere.
struct Touch {
    std::uint16_t a = 0, b = 0;  ///< labels
    int linked = 0;              ///< pairs of neighbouring cells where the surface goes on
    int side_by_side = 0;        ///< pairs of neighbouring cells
    double cost = -1;            ///< of merging them: < 1 is good, negative: not known
};

/// Collects which regions touch, most pairs once only.
class TouchList {
  public:
    void clear();
    void add(std::uint16_t a, std::uint16_t b, bool linked, bool side_by_side);
    /// Makes one entry of each pair, a < b, named by what the regions have become part of.
    void gather(MergedLabels& merged);

    std::vector<Touch>& entries() { return entries_; }

  private:
    std::vector<Touch> entries_;
    std::array<std::uint32_t, 256> recent_{};  // by a hash of the pair: index of its entry + 1
};

/// Distance along the plane's normal, metres, that a difference of inverse depth at depth z means.
double distance_of(double inverse_depth, double z, const InverseDepthPlane& plane);

/// Merges pairs that touch, those that fit best first, as long as there are any; `merged` is what has become
/// one. A region that became part of another is left empty.
void merge_regions(const MergeRules& rules, std::vector<MergeRegion>& regions, TouchList& touching,
                   MergedLabels& merged);

}  // namespace planemap::segmentation
