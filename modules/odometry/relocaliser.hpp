// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

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
    /// Whether planes bear out that a frame is where it was located, against a keyframe whose frame is gone:
    /// of the three largest regions of the frame one at least lies, by orientation and distance, on a plane
    /// that the keyframe saw, and not more contradict than agree. Where depth shows no plane, nothing bears
    /// it out.
    bool agrees(const Located& located, std::span<const PlanarRegion> regions) const;
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
