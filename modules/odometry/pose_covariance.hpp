// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "odometry/camera_motion.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// How uncertain frames are against their keyframes, from frame to frame: (translation, rotation) as
/// OdometryEstimate::covariance, without what the moments of frames add (CameraMotion::covariance_of_moment).
class PoseCovariance {
  public:
    /// The camera stands at a keyframe, or was found again: nothing is known of the frames before.
    void start();
    /// A frame was located. `predicted`: where it was expected, before the motion follows it. `goes_on`: the
    /// frame before was located against the same keyframe.
    void follow(const Located& located, const Guess& predicted, bool goes_on);

    /// Of the last frame: Located::covariance(); and where a direction is known by the prediction alone, that
    /// starts from a pose that is no surer, and uncertainty adds up from frame to frame. So does that of the
    /// velocity, of which nobody sees how it changes: by white accelerations, the n-th step is n times as
    /// uncertain as the first. Not where a motion prior says it, whose own uncertainty grows with the way.
    const Matrix6d& measured() const { return measured_; }

  private:
    Matrix6d measured_ = Matrix6d::Zero();
    int unseen_steps_ = 0;  ///< frames in a row that knew a direction by the prediction alone
};

/// Whether three standard deviations in any direction are less than 10 cm and 5 degrees.
bool says_where(const Matrix6d& covariance);

}  // namespace planemap::odometry
