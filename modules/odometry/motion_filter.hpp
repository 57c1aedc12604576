// SPDX-License-Identifier: BSD-3-Clause
// The camera's motion from one pose to the next: predicts, and takes the jitter out of measured poses.
#pragma once

#include "core/geometry/pose.hpp"

namespace planemap::odometry {

/// A constant-velocity filter (alpha-beta) whose gains follow the data.
///
/// How much a pose jitters and how much a motion changes are not known beforehand, and differ by orders of
/// magnitude between sensors, scenes and hands; only their ratio matters, the tracking index. It is chosen so
/// that innovations (measured against predicted) are white, as they are for the right Kalman filter: when
/// one points the way of the last, the filter is too slow; when it points back, it follows jitter.
/// Translation and rotation have an index each. Sources: Kalata 1984 (gains), Mehra 1970 (whiteness).
///
/// Rotations are taken as measured: hands and robots change them faster than they are mismeasured, and only
/// their velocity is filtered.
class MotionFilter {
  public:
    /// A velocity holds for at most longest_step_s seconds.
    explicit MotionFilter(double longest_step_s) : longest_step_s_(longest_step_s) {}

    /// At rest at a pose, nothing known of the motion. The indices stay: they belong to sensor and hand.
    void start(const Pose& odom_from_camera);

    /// Takes a pose measured `elapsed_s` > 0 seconds after the last one; returns the filtered one. After more
    /// than the longest step a pose is taken as measured, with the mean velocity since the last.
    Pose update(const Pose& odom_from_camera, double elapsed_s);

    const Pose& odom_from_camera() const { return odom_from_camera_; }
    /// Per second, in the camera's frame: camera(t + s) = pose_from_twist(s velocity) * camera(t), where
    /// camera(t) is camera_from_odom.
    const Twist& velocity() const { return velocity_; }
    /// What the velocity changes by for a unit of innovation (translation three times, rotation three times),
    /// a second.
    Twist velocity_gain(double elapsed_s) const;
    /// Variances of a measured pose beside the motion, as innovations tell: of white innovations of variance
    /// S, a filter of gain alpha takes (1 - alpha) S for jitter (Mehra 1970). Of translations what is left
    /// after filtering. Zero while nothing is known.
    Twist jitter() const;
    /// Variances of innovations: how far a motion is off from one pose to the next.
    Twist surprise() const;

  private:
    /// Innovations of translation or of rotation.
    struct Part {
        double log_index = 0;
        double mean_square = 0;
        Eigen::Vector3d last = Eigen::Vector3d::Zero();

        double alpha() const;
        double beta() const;
        void learn(const Eigen::Vector3d& innovation);
    };

    double longest_step_s_;
    Pose odom_from_camera_ = Pose::Identity();
    Twist velocity_ = Twist::Zero();
    int updates_ = 0;  ///< since start()
    Part translation_, rotation_;
};

}  // namespace planemap::odometry
