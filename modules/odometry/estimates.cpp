// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/estimates.hpp"

namespace planemap::odometry {

OdometryEstimate Estimates::at(const Keyframe& keyframe, const CameraMotion& motion) {
    OdometryEstimate estimate;
    estimate.status = TrackingStatus::kTracked;
    estimate.odom_from_camera = motion.odom_from_camera();
    estimate.keyframe_id = keyframe.id;
    return estimate;
}

void Estimates::expect(const Located& located, const CameraMotion& motion, std::int64_t utime) {
    const bool goes_on = last_.status != TrackingStatus::kLost && last_.keyframe_id == located.keyframe_id;
    covariance_.follow(located, motion.predict(utime, located.odom_from_keyframe), goes_on);
}

OdometryEstimate Estimates::of(const Located& located, const CameraMotion& motion,
                               const LocalKeyframe* keyframe) const {
    OdometryEstimate estimate;
    estimate.odom_from_camera = located.odom_from_camera();
    estimate.keyframe_id = located.keyframe_id;
    estimate.keyframe_from_camera = located.keyframe_from_camera();
    // The moment's is not in keyframes' edges: loop closures are without it, too, and the graph weighs one
    // against the other.
    estimate.covariance = covariance_.measured() +
                          motion.covariance_of_moment(located, keyframe ? keyframe->velocity : Twist::Zero());
    const bool is_sure = !located.track.degenerate && says_where(estimate.covariance);
    estimate.status = is_sure ? TrackingStatus::kTracked : TrackingStatus::kDegenerate;
    estimate.features = located.track.tried;
    estimate.inliers = located.track.inliers;
    estimate.residual_px = located.track.alignment.residual_px;
    estimate.velocity = -motion.velocity();  // of the camera in the world, not of the world in its frame
    return estimate;
}

OdometryEstimate Estimates::stale(const CameraMotion& motion, std::int64_t utime,
                                  const Pose& odom_from_keyframe) const {
    OdometryEstimate estimate = last_;
    if (estimate.status == TrackingStatus::kLost) return estimate;
    estimate.status = TrackingStatus::kStale;
    const double elapsed = motion.seconds_since_pose(utime);
    const Guess guess = motion.stand_still(utime, odom_from_keyframe);
    const Twist moved = elapsed * motion.velocity();
    estimate.covariance += guess.information.diagonal().cwiseInverse().asDiagonal();
    estimate.covariance += moved * moved.transpose();
    estimate.velocity.setZero();
    estimate.features = estimate.inliers = 0;
    estimate.residual_px = 0;
    return estimate;
}

}  // namespace planemap::odometry
