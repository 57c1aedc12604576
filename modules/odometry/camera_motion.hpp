// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "odometry/motion_filter.hpp"
#include "odometry/options.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// Where the camera was last and how it moves; with it, where a frame may be expected.
class CameraMotion {
  public:
    explicit CameraMotion(const OdometryOptions& options);

    const Pose& odom_from_camera() const { return filter_.odom_from_camera(); }
    /// See MotionFilter::velocity().
    const Twist& velocity() const { return filter_.velocity(); }
    double seconds_since_pose(std::int64_t utime) const;
    int lost_frames() const { return lost_frames_; }
    /// True when the motion of the last frames tells how the camera moves at `utime`.
    bool knows_velocity(std::int64_t utime) const;

    /// Where a frame is expected: constant velocity, or standing still after lost frames.
    Guess predict(std::int64_t utime, const Pose& odom_from_keyframe) const;
    /// Where it is if the camera stands where it was last.
    Guess stand_still(std::int64_t utime, const Pose& odom_from_keyframe) const;
    /// Whether the last pose is so recent that it says where the camera can be; after a pause it may be
    /// anywhere.
    bool is_bounded(std::int64_t utime) const;
    /// True when the camera can have come there since the last pose.
    bool is_plausible(const Pose& odom_from_camera, std::int64_t utime) const;

    /// The camera was here at this time, at rest, for all that is known.
    void stand_at(const Pose& odom_from_camera, std::int64_t utime);
    /// Begins anew at the last pose, at rest.
    void start(std::int64_t utime);
    /// Takes over a frame's pose, without its jitter (see Located::filtered), and the motion since the last.
    void follow(std::int64_t utime, Located& located);
    /// What moments and jitter add to Located::covariance() of the frame that was followed last. Stamps may
    /// all be late by one and the same time, which matters as far as the camera moves otherwise now than at
    /// the keyframe (keyframe_velocity, as velocity()); each stamp jitters by itself, which matters as far as
    /// the camera moves at all; both poses jitter; and what colour shows is brought to depth's moment by a
    /// velocity that is off by as much as motions were found to be.
    Matrix6d covariance_of_moment(const Located& located, const Twist& keyframe_velocity) const;
    /// A frame has no pose: nothing is known of the motion any more.
    void lose();

  private:
    Guess guess(std::int64_t utime, const Pose& odom_from_keyframe, bool moving) const;

    double acceleration_, angular_acceleration_, max_prediction_s_, stamp_jitter_s_;
    MotionFilter filter_;          ///< of the last frame with a pose
    std::int64_t pose_utime_ = 0;  ///< of the last frame with a pose
    double step_s_ = 0;            ///< to it from the one before
    int lost_frames_ = 0;          ///< since then
};

}  // namespace planemap::odometry
