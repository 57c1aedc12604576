// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/body_frame.hpp"

#include <algorithm>

namespace planemap::odometry {

Pose level_body_from_camera(const Eigen::Vector3d& up_camera) {
    constexpr double kStraight = 0.1;  // of the optical axis: what is left of it when laid level
    const Eigen::Vector3d optical_axis = Eigen::Vector3d::UnitZ(), image_down = Eigen::Vector3d::UnitY();
    const auto laid_level = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
        return v - v.dot(up_camera) * up_camera;
    };
    Eigen::Vector3d forward = laid_level(optical_axis);
    if (forward.norm() < kStraight)
        forward = laid_level(optical_axis.dot(up_camera) < 0 ? -image_down : image_down);
    forward.normalize();
    Pose body_from_camera = Pose::Identity();
    body_from_camera.linear() << forward.transpose(), up_camera.cross(forward).transpose(),
        up_camera.transpose();
    return body_from_camera;
}

void BodyFrame::see(const OdometryEstimate& estimate, const std::optional<Pose>& body_from_camera) {
    if (is_known()) return;
    if (!last_utime_) odom_from_first_camera_ = estimate.odom_from_camera;
    // A jump of the stamps, either way, is not time that was waited.
    waited_us_ +=
        std::clamp<std::int64_t>(estimate.utime - last_utime_.value_or(estimate.utime), 0, kLongestStep_us);
    last_utime_ = estimate.utime;
    if (body_from_camera) {
        decide(Source::kCameraFile, *body_from_camera);
    } else if (waited_us_ > kMaxWait_us) {
        decide(Source::kAssumed, level_body_from_camera(-Eigen::Vector3d::UnitY()));
    }
}

void BodyFrame::hear_up(const Eigen::Vector3d& up_odom) {
    if (is_known() || !last_utime_) return;
    decide(Source::kUp, level_body_from_camera(odom_from_first_camera_.linear().transpose() * up_odom));
}

void BodyFrame::decide(Source source, const Pose& body_from_camera) {
    source_ = source;
    body_from_camera_ = body_from_camera;
    local_from_odom_ = body_from_camera * odom_from_first_camera_.inverse();
}

BodyMotion BodyFrame::motion(const OdometryEstimate& estimate) const {
    const Pose local_from_camera = local_from_odom_ * estimate.odom_from_camera;
    const Pose camera_from_body = body_from_camera_.inverse();
    const Eigen::Vector3d velocity_camera = estimate.velocity.head<3>(),
                          rate_camera = estimate.velocity.tail<3>();
    BodyMotion motion;
    motion.local_from_body = local_from_camera * camera_from_body;
    motion.velocity_local =
        local_from_camera.linear() * (velocity_camera + rate_camera.cross(camera_from_body.translation()));
    motion.rotation_rate_body = body_from_camera_.linear() * rate_camera;
    return motion;
}

std::string BodyFrame::text() const {
    switch (source_) {
        case Source::kCameraFile:
            return "POSE_BODY by camera.json's body_from_camera";
        case Source::kUp:
            return "POSE_BODY is of a level camera at the first pose, by the map's up";
        case Source::kAssumed:
            return "POSE_BODY takes the first pose's camera for level: up was not known in the first 3 s, "
                   "and "
                   "camera.json has no body_from_camera";
        case Source::kNone:
            break;
    }
    return "POSE_BODY waits for up";
}

}  // namespace planemap::odometry
