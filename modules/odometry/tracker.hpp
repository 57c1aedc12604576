// SPDX-License-Identifier: BSD-3-Clause
// One frame held against one keyframe.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/keyframe.hpp"
#include "odometry/alignment.hpp"
#include "odometry/dense.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/options.hpp"
#include "odometry/prepared_frame.hpp"

namespace planemap::odometry {

/// Information of the data over the guess's below which a direction is known from the guess only.
inline constexpr double kWeakDirection = 4;

/// What is known of a frame's pose before it is tracked.
struct Guess {
    Pose camera_from_keyframe = Pose::Identity();
    Matrix6d information = Matrix6d::Zero();  ///< of the guess
    Twist velocity = Twist::Zero();           ///< see Alignment::velocity
    Twist velocity_gain = Twist::Zero();      ///< see MotionFilter; zero: the velocity stays as guessed
    Pose predicted_from_keyframe = Pose::Identity();  ///< where that velocity led to

    /// The velocity if the camera is at camera_from_keyframe.
    Twist velocity_at(const Pose& camera_from_keyframe) const;
};

/// A pose against a keyframe.
struct Track {
    AlignmentResult alignment;
    std::vector<cv::Point2f> pixels;  ///< of the keyframe's points in the frame
    std::vector<char> inlier;         ///< one per point of the keyframe
    int tried = 0;                    ///< points that flow found, or samples when only depth was used
    int inliers = 0;
    bool by_features = false;
    bool degenerate = false;                        ///< a direction is known from the guess only
    Matrix6d guess_information = Matrix6d::Zero();  ///< the guess's part of alignment.information
    bool by_prior = false;  ///< a motion prior took the guess's place where a direction is not seen
};

/// Where a frame is, and how it is known.
struct Located {
    Track track;
    int keyframe_id = -1;
    Pose odom_from_keyframe = Pose::Identity();
    bool relocalised = false;  ///< against a remembered keyframe that can no longer be tracked against
    bool filtered = true;      ///< its jitter is to be taken out; else the pose is taken as measured

    Pose keyframe_from_camera() const { return track.alignment.camera_from_keyframe.inverse(); }
    void move_to(const Pose& odom_from_camera) {
        track.alignment.camera_from_keyframe = odom_from_camera.inverse() * odom_from_keyframe;
    }
    Pose odom_from_camera() const { return orthonormalised(odom_from_keyframe * keyframe_from_camera()); }
    /// Of small motions of keyframe_from_camera in the camera frame, which are those of camera_from_keyframe
    /// reversed: of what was measured, see covariance_of().
    Matrix6d covariance() const;
};

/// How flow searches.
struct FlowSearch {
    const FlowPyramid* from = nullptr;
    const std::vector<cv::Point2f>* from_pixels = nullptr;  ///< one per point of the keyframe
    const std::vector<char>* usable = nullptr;              ///< points to start from; nullptr: all
    int levels = 3;
};

/// Flow from the keyframe (or another frame that saw its points) to the frame, started at the guess; then the
/// pose from points, surfaces, planes and guess together. Nothing when too few points fit one motion.
std::optional<Track> track_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& frame, const Guess& guess, const FlowSearch& search);

/// How many of the usable points are found where one motion near the guess has them; without the pose.
int count_points(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                 const Guess& guess, const FlowSearch& search);

/// The same as the first with flow from the keyframe's own image, on so many pyramid levels.
std::optional<Track> track_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& frame, const Guess& guess, int levels);

/// The pose from depth alone: point-to-plane against the keyframe's surface and planes, from the guess.
/// Nothing when too little of the surface is seen again.
std::optional<Track> track_surface(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                   const PreparedFrame& frame, const Guess& guess);

/// A better guess from the whole image at coarse levels against the last frame, and from depth against the
/// keyframe's surface: for blur and motions that the prediction missed.
Guess coarse_guess(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                   const Guess& guess, const DenseReference& last, const Pose& keyframe_from_last);

/// The frame's regions against the keyframe's at camera_from_keyframe: the sum over each region's points of
/// the squared distance to the keyframe's plane, exact from its moments. A plane counts as at most
/// `independent_points` points.
QuadraticTerm match_planes(std::span<const PlanarRegion> keyframe_regions,
                           std::span<const PlanarRegion> regions, const Pose& camera_from_keyframe,
                           const DepthNoise& noise, double independent_points);

}  // namespace planemap::odometry
