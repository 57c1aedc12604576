// SPDX-License-Identifier: BSD-3-Clause
// What both methods share: from labelled pixels to a region's outline and box.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/region.hpp"

namespace planemap {

/// Which readings count, in raw units: the sensor's valid values within its trusted range.
struct DepthRange {
    std::uint16_t low = 1, high = 0;  ///< inclusive; empty when high < low

    explicit DepthRange(const CameraInfo& camera);
    bool contains(std::uint16_t raw) const { return raw >= low && raw <= high; }
};

/// Gives each region its box and outline from a label image (i + 1: on regions[i]). plane, moments and rms
/// of the regions must be set. The outline follows the pixels on a grid of width / 160 pixels; parts smaller
/// than a grid cell are left out. The box holds the outline, and 3 RMS on either side of the plane.
class ShapeTracer {
  public:
    void trace_all(const Image<std::uint16_t>& labels, const CameraInfo& camera,
                   std::vector<PlanarRegion>& regions);

  private:
    struct Extent {
        int left, top, right, bottom;  // blocks, right and bottom exclusive
    };
    /// Marks the columns of rows v0 to v1 - 1 where labels differ from each other or from the next column.
    void find_changes(const Image<std::uint16_t>& labels, int v0, int v1);
    void find_blocks(const Image<std::uint16_t>& labels, std::size_t regions);
    void shape(const PinholeCamera& camera, double farthest_m, std::uint16_t label, PlanarRegion& region);

    int block_px_ = 1;
    std::vector<std::uint16_t> changes_;
    Image<std::uint16_t> blocks_;  // label of most pixels of each block, or 0
    std::vector<Extent> extents_;  // of each region
    Mask mask_;
};

}  // namespace planemap
