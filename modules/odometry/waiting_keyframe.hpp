// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "core/keyframe.hpp"
#include "odometry/keyframe_making.hpp"
#include "odometry/options.hpp"
#include "odometry/relocaliser.hpp"

namespace planemap::odometry {

/// The newest keyframe between the frame that it is made of and the next one, in which it is described: so
/// that no frame takes as long as both. Once described, the relocaliser knows it.
class WaitingKeyframe {
  public:
    /// Both must outlive it.
    WaitingKeyframe(const OdometryOptions& options, Relocaliser& relocaliser)
        : options_(options), relocaliser_(relocaliser) {}

    /// A keyframe of this frame waits from now on; id, poses and edge are left to the caller, who may change
    /// it until another call. Precondition: none waits.
    Keyframe& begin(const PreparedFrame& frame, const FrameMotion& motion);
    /// The one that waits, described. Precondition: one waits.
    Keyframe describe_at_once();
    /// Describes the one that waits, if one does; take() gives it.
    void describe();
    /// What describe() described, once.
    std::optional<Keyframe> take();

  private:
    const OdometryOptions& options_;
    Relocaliser& relocaliser_;
    std::unique_ptr<UndescribedKeyframe> waiting_;
    std::optional<Keyframe> described_;
};

}  // namespace planemap::odometry
