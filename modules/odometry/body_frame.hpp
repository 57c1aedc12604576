// SPDX-License-Identifier: BSD-3-Clause
// The robot's frames that POSE_BODY speaks of, from those of its camera.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/body_motion.hpp"
#include "core/keyframe.hpp"

namespace planemap::odometry {

/// The body frame (x forward, z up) of a level robot that carries the camera, origin in the camera: z along
/// `up_camera` (unit, camera frame), x along the optical axis laid level. Of a camera that looks straight up
/// or down, x is where the top of a camera pitched up to there would have looked: the image's top when it
/// looks down, its bottom when it looks up.
Pose level_body_from_camera(const Eigen::Vector3d& up_camera);

/// Decides once, and for good, how the body lies in the camera's frame, and where the local frame is: where
/// the body was at the first tracked frame. Every source of the decision is asked once it can answer:
/// camera.json at the first frame; else the map's up, as soon as it is known; if that is not within
/// kMaxWait_us of the frames' time, the camera counts as level.
class BodyFrame {
  public:
    static constexpr std::int64_t kMaxWait_us = 3000000, kLongestStep_us = 500000;
    enum class Source { kNone, kCameraFile, kUp, kAssumed };

    /// A frame was tracked, the first one among them; `body_from_camera` is what camera.json says, if it
    /// does.
    void see(const OdometryEstimate& estimate, const std::optional<Pose>& body_from_camera);
    /// Up became known: a unit vector in the odom frame. Ignored once a decision stands, and before a frame.
    void hear_up(const Eigen::Vector3d& up_odom);

    Source source() const { return source_; }
    bool is_known() const { return source_ != Source::kNone; }
    /// How the local frame lies about the odom frame. Precondition: is_known().
    const Pose& local_from_odom() const { return local_from_odom_; }
    const Pose& body_from_camera() const { return body_from_camera_; }
    /// Where the body is and how it moves, of a tracked frame. Precondition: is_known().
    BodyMotion motion(const OdometryEstimate& estimate) const;
    /// For the status: where the body frame is from.
    std::string text() const;

  private:
    void decide(Source source, const Pose& body_from_camera);

    Source source_ = Source::kNone;
    std::optional<std::int64_t> last_utime_;  ///< of the last tracked frame, until the decision
    std::int64_t waited_us_ = 0;
    Pose odom_from_first_camera_ = Pose::Identity();
    Pose body_from_camera_ = Pose::Identity(), local_from_odom_ = Pose::Identity();
};

}  // namespace planemap::odometry
