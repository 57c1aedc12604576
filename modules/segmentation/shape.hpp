// SPDX-License-Identifier: BSD-3-Clause
// What both methods share: from labelled pixels to a region's outline and box.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/crossing.hpp"
#include "core/image.hpp"
#include "core/region.hpp"

namespace planemap::segmentation {

/// Which readings count, in raw units: the sensor's valid values within its trusted range.
struct DepthRange {
    std::uint16_t low = 1, high = 0;  ///< inclusive; empty when high < low

    explicit DepthRange(const CameraInfo& camera);
    bool contains(std::uint16_t raw) const { return raw >= low && raw <= high; }
};

/// Gives each region its box and outline from a label image (i + 1: on regions[i]). plane, moments and rms
/// of the regions must be set. The outline follows the pixels on a grid of width / 160 pixels; parts smaller
/// than a grid cell are left out. Every vertex lies within nine tenths of a grid cell (as long as it is at
/// the reading's distance, seen from the front) of one of the region's readings: where a plane is seen at a
/// grazing angle, a pixel beside the last reading may lie metres beyond it. The box holds the outline, and 3
/// RMS on either side of the plane.
class ShapeTracer {
  public:
    /// Takes the memory of old outlines for the next ones. Call it before regions are dropped.
    void recycle(std::vector<PlanarRegion>& regions);

    /// Preconditions: labels has the depth image's size, and labelled pixels are valid readings.
    void trace_all(const DepthImage& depth, const Image<std::uint16_t>& labels, const CameraInfo& camera,
                   std::vector<PlanarRegion>& regions);

  private:
    template <int kSide>
    void find_blocks(const Image<std::uint16_t>& labels);
    void find_blocks(const Image<std::uint16_t>& labels, int block_px);
    void trace_rings(std::vector<PlanarRegion>& regions);
    void follow(int x, int y, std::uint16_t label);
    void add_ring(std::vector<PlanarRegion>& regions, std::uint16_t label);
    void shape(const CameraInfo& camera, std::uint16_t label, PlanarRegion& region);
    Eigen::Vector3d held(const Eigen::Vector2d& corner, const Eigen::Vector3d& p, const CameraInfo& camera,
                         std::uint16_t label, const Plane& plane) const;

    const DepthImage* depth_ = nullptr;  // during trace_all()
    const Image<std::uint16_t>* labels_ = nullptr;
    int block_px_ = 1;
    Image<std::uint16_t> blocks_;         // label of most pixels of each block, or 0; a block of 0 around
    std::vector<std::uint8_t> followed_;  // blocks whose upper edge is part of a ring
    Ring ring_;                           // being made, in blocks
    RingSimplifier simplifier_;
    CrossingRemover crossing_remover_;
    std::vector<Eigen::Vector3d> corners_;
    std::vector<Ring> spare_rings_;
    std::vector<std::vector<Ring>> spare_lists_;
    std::size_t longest_ring_ = 0;
};

}  // namespace planemap::segmentation
