// SPDX-License-Identifier: BSD-3-Clause
// What wheels or an IMU say of the robot's motion, where the camera does not see it.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "odometry/motion_prior.hpp"
#include "odometry/options.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// Fills the directions that a frame is known in by the prediction alone (a slide along a blank wall) with
/// what the priors say of the motion since the frame's keyframe, and holds them against the directions that
/// are seen. A prior that contradicts what is seen twice is not used before it has agreed with frames that
/// see all six directions for ten frames, or up to thirty after more.
class MotionPriors {
  public:
    explicit MotionPriors(const MotionPriorOptions& options) : options_(options) {}

    /// Priors come in order of time. One that goes back in time begins anew; one that is no pose, or repeats
    /// a time, is left out: false.
    bool hear(const MotionPrior& prior);

    /// Moves `track`, of a frame of `utime` against a keyframe of `keyframe_utime`, and tells what it did.
    /// In the directions that it filled, what the prior knows takes the place of the prediction in the
    /// track's information: less than that, after a long way since the keyframe.
    PriorUse apply(Track& track, std::int64_t keyframe_utime, std::int64_t utime,
                   const std::optional<Pose>& body_from_camera);

  private:
    struct Heard {
        MotionPrior prior;
        double path_m = 0, path_rad = 0;  ///< since the first one that was heard
    };
    std::optional<Heard> at(std::int64_t utime) const;

    MotionPriorOptions options_;
    std::deque<Heard> heard_;
    int distrust_ = 0;
};

}  // namespace planemap::odometry
