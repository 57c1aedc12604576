// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/keyframe.hpp"
#include "odometry/camera_motion.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/pose_covariance.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// What odometry says of each frame: where the camera is and how sure that is, from frame to frame. Times and
/// chains are left to the caller.
class Estimates {
  public:
    /// Covariances begin anew: the camera stands at a keyframe, or was found again.
    void start() { covariance_.start(); }

    /// Of a frame that became a keyframe without an edge, or the first one after a restart.
    static OdometryEstimate at(const Keyframe& keyframe, const CameraMotion& motion);
    /// A frame was located. Before the motion follows it: that says where it was expected.
    void expect(const Located& located, const CameraMotion& motion, std::int64_t utime);
    /// Of that frame, after the motion has followed it. `keyframe`: that it was located against; nullptr: it
    /// is gone.
    OdometryEstimate of(const Located& located, const CameraMotion& motion,
                        const LocalKeyframe* keyframe) const;
    /// Where the camera is when nothing new was seen: where it was, as far as it cannot have moved since.
    /// Lost if it was.
    OdometryEstimate stale(const CameraMotion& motion, std::int64_t utime,
                           const Pose& odom_from_keyframe) const;

    /// What was said of a frame; later ones go on from it. Those of stale frames change nothing.
    void said(const OdometryEstimate& estimate) {
        if (estimate.status != TrackingStatus::kStale) last_ = estimate;
    }

    /// Of the last located frame, for the edge of a keyframe: see PoseCovariance::measured().
    const Matrix6d& measured_covariance() const { return covariance_.measured(); }

  private:
    OdometryEstimate last_;  ///< of the last frame that was not stale
    PoseCovariance covariance_;
};

}  // namespace planemap::odometry
