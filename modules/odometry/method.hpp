// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "odometry/camera_motion.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/relocaliser.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// What a frame is located by. There is a current keyframe.
struct References {
    const CameraMotion& motion;
    const LocalKeyframes& keyframes;
    const Relocaliser& relocaliser;
};

/// A way to tell where frames are against keyframes. It is told of every frame in order of time, and keeps of
/// the last one what it needs to go on from there.
class Method {
  public:
    virtual ~Method() = default;

    /// Where a frame is; nothing when it is lost.
    virtual std::optional<Located> locate(const PreparedFrame& frame, const References& known) = 0;
    /// Whether a keyframe is wanted although the camera is still near the one that the frame was located
    /// against. After follow().
    virtual bool wants_keyframe(const PreparedFrame& frame, const Located& located,
                                const LocalKeyframe& keyframe) const = 0;

    /// A frame begins anew, without a motion before it. It need not become a keyframe.
    virtual void begin(const PreparedFrame& frame) = 0;
    /// A frame's pose is taken over, `elapsed_s` after the last one's.
    virtual void follow(const PreparedFrame& frame, const Located& located, double elapsed_s) = 0;
    /// A frame has no pose.
    virtual void lose() = 0;

    /// The next frame goes on from this one, as it was tracked. May take the frame's pyramid.
    virtual void go_on_from(PreparedFrame& frame, const Track& track) = 0;
    /// The next frame goes on from this one, which became a keyframe. May take the frame's pyramid.
    virtual void go_on_from(PreparedFrame& frame, const LocalKeyframe& keyframe) = 0;
};

/// The method that the options ask for.
std::unique_ptr<Method> make_method(const OdometryOptions& options);

}  // namespace planemap::odometry
