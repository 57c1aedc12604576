// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "odometry/camera_motion.hpp"
#include "odometry/known_keyframes.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/options.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// Finds a lost camera again by what earlier keyframes saw.
class Relocaliser {
  public:
    explicit Relocaliser(const OdometryOptions& options);

    /// Remembers a keyframe. Precondition: the frame has colour.
    void add(const Keyframe& keyframe, const PreparedFrame& frame);
    /// The same of one whose frame is gone.
    void add(const Keyframe& keyframe);
    void clear() { known_.clear(); }

    /// The frame's descriptors against remembered keyframes, refined by flow where the keyframe is still a
    /// local one. Nothing when none fits, or the camera cannot have come there. Precondition: the frame has
    /// colour.
    std::optional<Located> locate(const PreparedFrame& frame, const CameraMotion& motion,
                                  const LocalKeyframes& local) const;

  private:
    OdometryOptions options_;
    KnownKeyframes known_;
};

}  // namespace planemap::odometry
