// SPDX-License-Identifier: BSD-3-Clause
// A method that finds planes in depth images, ours or another's.
#pragma once

#include "segmentation/segmenter.hpp"

namespace planemap::benchmark {

/// Finds planes in two steps, so that only the first is timed.
class Finder {
  public:
    virtual ~Finder() = default;
    /// All the work a user of the method has to wait for: from the depth image to planes and labels in the
    /// method's own form.
    virtual void find(const DepthImage& depth, const CameraInfo& camera) = 0;
    /// The planes and labels of the last find() in ours. Of the regions only `plane` and what the method
    /// itself gives are set.
    virtual void result(segmentation::Segmentation& out) = 0;
};

/// Has the finder take every step-th pixel; returns the thread's CPU time in milliseconds, decimation
/// included. Precondition: step >= 1.
double timed_find(Finder& finder, const DepthImage& depth, const CameraInfo& camera, int step);

}  // namespace planemap::benchmark
