// SPDX-License-Identifier: BSD-3-Clause
// What is kept of a frame that becomes a keyframe.
#pragma once

#include "core/keyframe.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/options.hpp"
#include "odometry/prepared_frame.hpp"

namespace planemap::odometry {

/// How the camera moves while it takes a frame.
struct FrameMotion {
    Twist velocity = Twist::Zero();  ///< see Alignment::velocity
    double color_offset_s = 0;       ///< colour time minus depth time, as well as it is known
};

/// The frame's corners, depth and regions as frames are tracked against them, all as they were at the depth
/// image's time. Id and pose are left to the caller.
LocalKeyframe make_local_keyframe(const OdometryOptions& options, const PreparedFrame& frame,
                                  const FrameMotion& motion);

/// The frame's regions and described features at the depth image's time, for the graph and for
/// relocalisation. Id, poses and edge are left to the caller.
Keyframe make_keyframe(const OdometryOptions& options, const PreparedFrame& frame, const FrameMotion& motion);

/// A keyframe that is described later than it is made: half of what a keyframe costs.
class UndescribedKeyframe {
  public:
    /// Copies the frame's images. Id, poses and edge of `keyframe` are left to the caller.
    UndescribedKeyframe(const PreparedFrame& frame, const FrameMotion& motion);
    UndescribedKeyframe(const UndescribedKeyframe&) = delete;
    UndescribedKeyframe& operator=(const UndescribedKeyframe&) = delete;

    Keyframe keyframe;

    bool has_color() const { return frame_.gray != nullptr; }
    /// The keyframe with the features that make_keyframe() gives it.
    Keyframe described(const OdometryOptions& options) const;

  private:
    GrayImage gray_;
    DepthImage depth_;
    CameraInfo camera_;
    PreparedFrame frame_;  ///< of these
    FrameMotion motion_;
};

}  // namespace planemap::odometry
