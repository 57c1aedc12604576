// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "odometry/dense.hpp"
#include "odometry/flow.hpp"
#include "odometry/method.hpp"
#include "odometry/options.hpp"

namespace planemap::odometry {

/// The default method: corners of a keyframe are followed by flow, and refined together with its depth and
/// planes. When that fails, from a guess by the whole image; then among the known keyframes; then by depth
/// alone.
class PlanarMethod : public Method {
  public:
    explicit PlanarMethod(const OdometryOptions& options) : options_(options) {}

    std::optional<Located> locate(const PreparedFrame& frame, const References& known) override;
    bool wants_keyframe(const PreparedFrame& frame, const Located& located,
                        const LocalKeyframe& keyframe) const override;

    void begin(const PreparedFrame& frame) override;
    void follow(const PreparedFrame& frame, const Located& located, double elapsed_s) override;
    void lose() override;

    void go_on_from(PreparedFrame& frame, const Track& track) override;
    void go_on_from(PreparedFrame& frame, const LocalKeyframe& keyframe) override;

  private:
    std::optional<Track> second_chances(const PreparedFrame& frame, const LocalKeyframe& keyframe,
                                        const Guess& better) const;
    std::optional<Track> track_geometry(const PreparedFrame& frame, const References& known,
                                        const Guess& guess, const std::optional<Guess>& by_image) const;
    /// True when features have not been found for some frames, and are not looked for any harder in this one.
    bool is_blind() const;

    OdometryOptions options_;
    int blind_frames_ = 0;       ///< poses in a row that rest on depth alone
    DenseReference last_dense_;  ///< of the last frame with a pose
    FlowPyramid last_pyramid_;   ///< of the last frame, when it was tracked by features
    std::vector<cv::Point2f> last_pixels_;
    std::vector<char> last_inlier_;
};

}  // namespace planemap::odometry
