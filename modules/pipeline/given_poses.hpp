// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/keyframe.hpp"
#include "core/trajectory.hpp"
#include "messages/bus.hpp"

namespace planemap::pipeline {

/// Pose at a time, interpolated between poses at most 0.1 s apart; nothing where there are none.
std::optional<Pose> given_pose(const Trajectory& trajectory, std::int64_t utime);

/// Stands in for the graph: keyframes take their poses from a trajectory of the colour camera, in its world.
class GivenPoses {
  public:
    GivenPoses(messages::Bus& bus, Trajectory poses);

    const Trajectory& poses() const { return poses_; }
    /// Of the keyframes that there is a pose for.
    const KeyframeTrajectory& keyframes() const { return keyframes_; }
    /// Keyframes that there is no pose for; they are not mapped.
    int missing() const { return missing_; }
    /// True if there were keyframes, and no pose for any of them.
    bool fit_nothing() const { return missing_ > 0 && keyframes_.keyframes.empty(); }

  private:
    void on_keyframe(const messages::RawMessage& message);

    messages::Bus& bus_;
    Trajectory poses_;
    KeyframeTrajectory keyframes_;
    int missing_ = 0;
    std::int32_t seq_ = 0;
};

}  // namespace planemap::pipeline
