// SPDX-License-Identifier: BSD-3-Clause
// Depth images of a run, few and thinned out, to hold its map against.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "evaluate/spread.hpp"

namespace planemap::evaluation {

/// A depth image of which every stride-th pixel in x and y is left: a pinhole camera's image, too.
struct DepthView {
    std::int64_t utime = 0;  ///< microseconds
    PinholeCamera camera;    ///< of the thinned image
    Pose color_from_depth = Pose::Identity();
    DepthNoise noise;
    Image<float> metres;   ///< along the optical axis; 0: no reading that the sensor is trusted with
    Image<Rgb> colors;     ///< of the readings; CloudPoint::kNoColor where the colour camera does not look
    std::size_t readings;  ///< that are not 0

    /// Thinned to at most `columns` columns. The picture is the colour camera's, of any size. Precondition:
    /// the depth image is the depth camera's.
    DepthView(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us, int columns,
              const std::optional<RgbImage>& picture = std::nullopt);

  private:
    void take_colors(const RgbImage& picture, const PinholeCamera& color_camera);
};

/// Views spread evenly over a run of any length (Spread).
class SpreadViews {
  public:
    static constexpr std::size_t kMost = 100;
    static constexpr int kColumns = 160;

    /// A small picture of the colours, one pixel for `reduction` x `reduction` (1, 2, 4 or 8); nothing
    /// without colour.
    using Picture = std::function<std::optional<RgbImage>(int reduction)>;

    /// Takes every frame of the run, in order; its picture is asked for only if it is kept.
    void add(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us,
             const Picture& picture = {});
    const std::vector<DepthView>& views() const { return views_.kept(); }

  private:
    Spread<DepthView> views_{kMost};
};

}  // namespace planemap::evaluation
