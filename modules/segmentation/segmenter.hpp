// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/region.hpp"
#include "segmentation/shape.hpp"

namespace planemap::segmentation {

/// The planar regions of one depth image, in the depth camera's frame, normals towards the sensor (d > 0).
struct Segmentation {
    std::vector<PlanarRegion> regions;  ///< largest number of inliers first
    Image<std::uint16_t> labels;        ///< size of the depth image; 0: none, i + 1: on regions[i]
};

/// Depth image to planar regions. A segmenter keeps buffers from frame to frame, but no state: the same
/// image gives the same result whatever came before. Not for use from two threads at once.
class Segmenter {
  public:
    virtual ~Segmenter() = default;

    /// Segments `depth` as seen by `camera.depth`; units, range and noise are those of `camera`. Readings
    /// that are invalid or out of range carry no label; an image without valid readings gives no regions.
    /// `out` is overwritten and its buffers are reused. Throws std::invalid_argument when the camera is not
    /// valid or the image has not the size of camera.depth.
    void segment(const DepthImage& depth, const CameraInfo& camera, Segmentation& out);

    /// The same without outlines and boxes, which are left empty, for who does not ask for them: a good part
    /// of the time is theirs.
    void label(const DepthImage& depth, const CameraInfo& camera, Segmentation& out);

  private:
    /// label() for input that is right. `out` holds an earlier result without its outlines.
    virtual void find(const DepthImage& depth, const CameraInfo& camera, Segmentation& out) = 0;

    ShapeTracer tracer_;
};

/// Throws what Segmenter::segment() promises for a bad camera or an image of the wrong size.
void check_input(const DepthImage& depth, const CameraInfo& camera);

}  // namespace planemap::segmentation
