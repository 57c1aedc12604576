// SPDX-License-Identifier: BSD-3-Clause
// Depth images of a run, few and thinned out, to hold its map against.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap::evaluation {

/// A depth image of which every stride-th pixel in x and y is left: a pinhole camera's image, too.
struct DepthView {
    std::int64_t utime = 0;  ///< microseconds
    PinholeCamera camera;    ///< of the thinned image
    Pose color_from_depth = Pose::Identity();
    DepthNoise noise;
    Image<float> metres;  ///< along the optical axis; 0: no reading that the sensor is trusted with

    /// Thinned to at most `columns` columns. Precondition: the image is the depth camera's.
    DepthView(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us, int columns);
};

/// Views spread evenly over a run of any length: every frame until there are `most`, then every second one
/// and so on, the earlier ones thinned out alike. So at least half of `most` are kept of a long run.
class SpreadViews {
  public:
    static constexpr std::size_t kMost = 100;
    static constexpr int kColumns = 160;

    /// Takes every frame of the run, in order.
    void add(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us);
    const std::vector<DepthView>& views() const { return views_; }

  private:
    std::vector<DepthView> views_;
    std::int64_t frames_ = 0, every_ = 1;
};

}  // namespace planemap::evaluation
