// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/camera_motion.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::odometry {
namespace {

constexpr double kUsual = 0.01;  // metres and radians by which a prediction is off at any rate
constexpr double kReach = 0.3;   // metres and radians that a camera may always have moved
constexpr double kPause = 1.5;   // seconds without a pose after which it may be anywhere

}  // namespace

CameraMotion::CameraMotion(const OdometryOptions& options)
    : acceleration_(options.acceleration),
      angular_acceleration_(options.angular_acceleration),
      max_prediction_s_(options.max_prediction_s),
      stamp_jitter_s_(options.color_jitter_s),
      filter_(options.max_prediction_s) {}

double CameraMotion::seconds_since_pose(std::int64_t utime) const {
    return seconds(utime - pose_utime_);
}

bool CameraMotion::knows_velocity(std::int64_t utime) const {
    return lost_frames_ == 0 && utime > pose_utime_ && seconds_since_pose(utime) <= max_prediction_s_;
}

Guess CameraMotion::predict(std::int64_t utime, const Pose& odom_from_keyframe) const {
    return guess(utime, odom_from_keyframe, lost_frames_ == 0);
}

Guess CameraMotion::stand_still(std::int64_t utime, const Pose& odom_from_keyframe) const {
    return guess(utime, odom_from_keyframe, false);
}

Guess CameraMotion::guess(std::int64_t utime, const Pose& odom_from_keyframe, bool moving) const {
    Guess guess;
    const double elapsed = std::clamp(seconds_since_pose(utime), 0.0, 10.0);
    const Twist motion = filter_.velocity() * (moving ? std::min(elapsed, max_prediction_s_) : 0.0);
    guess.camera_from_keyframe =
        pose_from_twist(motion) * filter_.odom_from_camera().inverse() * odom_from_keyframe;
    const double off = kUsual + acceleration_ * elapsed * elapsed;
    const double turned = kUsual + angular_acceleration_ * elapsed * elapsed;
    guess.information.diagonal() << Eigen::Vector3d::Constant(1 / (off * off)),
        Eigen::Vector3d::Constant(1 / (turned * turned));
    if (!moving) return guess;
    guess.velocity = filter_.velocity();
    guess.predicted_from_keyframe = guess.camera_from_keyframe;
    if (knows_velocity(utime)) guess.velocity_gain = filter_.velocity_gain(elapsed);
    return guess;
}

bool CameraMotion::is_bounded(std::int64_t utime) const {
    return seconds_since_pose(utime) <= kPause;
}

bool CameraMotion::is_plausible(const Pose& odom_from_camera, std::int64_t utime) const {
    const double elapsed = seconds_since_pose(utime), reach = kReach + acceleration_ * elapsed;
    const Pose moved = filter_.odom_from_camera().inverse() * odom_from_camera;
    return moved.translation().norm() < reach * (1 + elapsed) &&
           rotation_angle(moved) < reach * (1 + elapsed);
}

void CameraMotion::stand_at(const Pose& odom_from_camera, std::int64_t utime) {
    filter_.start(odom_from_camera);
    pose_utime_ = utime;
    lost_frames_ = 0;
}

void CameraMotion::start(std::int64_t utime) {
    filter_.start(filter_.odom_from_camera());
    pose_utime_ = utime;
    lost_frames_ = 0;
}

void CameraMotion::follow(std::int64_t utime, Located& located) {
    const double elapsed = seconds_since_pose(utime);
    if (lost_frames_ > 0 || located.relocalised || !located.filtered || !(elapsed > 0))
        filter_.start(located.odom_from_camera());
    else
        located.move_to(filter_.update(located.odom_from_camera(), elapsed));
    step_s_ = elapsed;
    pose_utime_ = utime;
    lost_frames_ = 0;
}

Matrix6d CameraMotion::covariance_of_moment(const Located& located, const Twist& keyframe_velocity) const {
    const Pose& camera_from_keyframe = located.track.alignment.camera_from_keyframe;
    // The keyframe's motion as seen from the camera.
    const Eigen::Vector3d turn = camera_from_keyframe.linear() * keyframe_velocity.tail<3>();
    Twist at_keyframe;
    at_keyframe << camera_from_keyframe.linear() * keyframe_velocity.head<3>() +
                       camera_from_keyframe.translation().cross(turn),
        turn;
    Matrix6d covariance = Matrix6d::Zero();
    const auto add = [&](double sigma_s, const Twist& rate) {
        covariance += sigma_s * sigma_s * rate * rate.transpose();
    };
    // Late by any part of a time, and nothing of it is corrected: the mean is sqrt(3) sigma, the RMS two.
    add(2 * OdometryOptions::stamp_sigma_s, velocity() - at_keyframe);
    add(stamp_jitter_s_, velocity());
    add(stamp_jitter_s_, at_keyframe);
    const double offset_s = located.track.by_features ? located.track.alignment.color_offset_s : 0;
    const double share = step_s_ > 0 ? std::min(1.0, std::abs(offset_s) / step_s_) : 0;
    covariance.diagonal() += 2 * filter_.jitter() + share * share * filter_.surprise();
    return covariance;
}

void CameraMotion::lose() {
    ++lost_frames_;
    filter_.start(filter_.odom_from_camera());
}

}  // namespace planemap::odometry
