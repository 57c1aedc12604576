// SPDX-License-Identifier: BSD-3-Clause
// What odometry hands to the graph, and the graph to the map.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/pose.hpp"
#include "core/region.hpp"

namespace planemap {

enum class TrackingStatus : std::int8_t {
    kLost = 0,     ///< no pose
    kTracked = 1,  ///< a pose, all directions determined
    kDegenerate =
        2,       ///< a pose, some directions known by the prediction only, or 3 sigma over 10 cm or 5 degrees
    kStale = 3,  ///< nothing new was seen: the last pose, and a covariance that grows
};

/// Whether a frame's own images say where it is.
constexpr bool is_tracked(TrackingStatus status) {
    return status == TrackingStatus::kTracked || status == TrackingStatus::kDegenerate;
}

/// Where the camera is after one frame. The odom frame is smooth: no loop closure moves it.
struct OdometryEstimate {
    std::int64_t utime = 0;  ///< of the frame (its depth image), microseconds
    std::int64_t pose_utime =
        0;  ///< moment the pose is of (the colour image's time if colour was used), microseconds
    TrackingStatus status = TrackingStatus::kLost;  ///< when lost, the poses mean nothing
    Pose odom_from_camera = Pose::Identity();
    int keyframe_id = -1;  ///< keyframe this frame was tracked against
    Pose keyframe_from_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< of keyframe_from_camera: translation, rotation; camera frame
    int features = 0;                        ///< features or terms tried
    int inliers = 0;
    double residual_px = 0;  ///< RMS reprojection error of the inliers
    int chain = -1;          ///< Keyframe::chain of the keyframe; not in the message
    /// How the camera moves, filtered: of its centre, m/s, and its rotation, rad/s, both in the camera frame.
    /// Zero while it is not known: at the first pose and after lost frames. Not in the message.
    Twist velocity = Twist::Zero();
};

/// Whether it says where the frame was: tracked, or so short a time after the last new image that two
/// standard deviations are less than 10 cm and 5 degrees.
inline bool is_placed(const OdometryEstimate& estimate) {
    constexpr double kFar_m = 0.05, kFar_rad = 0.0436;
    if (estimate.status != TrackingStatus::kStale) return is_tracked(estimate.status);
    const auto variances = estimate.covariance.diagonal();
    return variances.head<3>().maxCoeff() < kFar_m * kFar_m &&
           variances.tail<3>().maxCoeff() < kFar_rad * kFar_rad;
}

/// A 256-bit binary descriptor; compared by Hamming distance.
using Descriptor = std::array<std::uint8_t, 32>;

/// One 2D feature with its 3D point. Planar ones lie exactly on their region (paper section 2.2).
struct Feature {
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< u, v in the colour image
    Eigen::Vector3f point = Eigen::Vector3f::Zero();  ///< camera frame, metres
    int region = -1;                                  ///< index into the keyframe's regions, -1: on no plane
    Descriptor descriptor{};
};

/// A frame worth keeping.
struct Keyframe {
    std::int64_t utime = 0;       ///< of the frame (its depth image), microseconds
    std::int64_t pose_utime = 0;  ///< moment the pose is of, microseconds
    int id = -1;                  ///< 0, 1, 2, ... in order of time
    Pose odom_from_camera = Pose::Identity();
    /// Id of the first keyframe of its odom frame: poses of one chain can be compared, of two they cannot;
    /// -1: not known.
    int chain = -1;
    int previous_id = -1;  ///< keyframe the edge leads from; -1: none (first one, or after a loss)
    Pose previous_from_camera = Pose::Identity();  ///< the edge
    Matrix6d covariance = Matrix6d::Zero();        ///< of the edge: translation, rotation; camera frame
    std::vector<Feature> features;
    std::vector<PlanarRegion> regions;  ///< camera frame
    DepthNoise noise;                   ///< of the sensor that saw it: what its features and regions weigh
    double depth_min_m = 0.3, depth_max_m = 8.0;  ///< range of that sensor
};

/// Pose of one keyframe after graph optimisation.
struct KeyframePose {
    int id = -1;
    std::int64_t utime = 0;  ///< Keyframe::utime
    Pose world_from_camera = Pose::Identity();
    /// Id of the first keyframe that it hangs together with, by odometry and loop closures. Each component
    /// has a world frame of its own, and where one lies in another is not known.
    int component = 0;
};

/// All keyframe poses after graph optimisation.
struct KeyframeTrajectory {
    std::int64_t utime = 0;                   ///< of the newest keyframe
    int revision = 0;                         ///< grows when earlier keyframes moved
    int loop_closures = 0;                    ///< accepted so far
    Pose world_from_odom = Pose::Identity();  ///< correction for frames after the newest keyframe: its world
    std::vector<KeyframePose> keyframes;      ///< ascending id
};

}  // namespace planemap
