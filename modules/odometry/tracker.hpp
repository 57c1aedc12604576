// SPDX-License-Identifier: BSD-3-Clause
// One frame held against one keyframe.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/keyframe.hpp"
#include "odometry/alignment.hpp"
#include "odometry/dense.hpp"
#include "odometry/flow.hpp"
#include "odometry/options.hpp"
#include "odometry/surface.hpp"

namespace planemap::odometry {

/// A frame prepared for tracking.
struct PreparedFrame {
    std::int64_t utime = 0;     ///< depth time, microseconds
    double color_offset_s = 0;  ///< colour time minus depth time
    double readout_s = 0;       ///< see Alignment
    const GrayImage* gray = nullptr;
    const DepthImage* depth = nullptr;
    const CameraInfo* camera = nullptr;
    FlowPyramid pyramid;  ///< empty without colour
    std::vector<SurfaceSample> samples;
    std::vector<PlanarRegion> regions;  ///< the valid ones
};

/// A corner of a keyframe with its 3D point.
struct TrackPoint {
    cv::Point2f pixel;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< keyframe camera frame at its depth time, metres
    Eigen::Vector3d per_readout = Eigen::Vector3d::Zero();  ///< see PointTerm::point_per_readout
    double inverse_depth_sigma = 0;                         ///< 1/m
    int region = -1;                                        ///< region it was regularised to; -1: none
};

/// A keyframe that frames are tracked against.
struct LocalKeyframe {
    int id = -1;
    std::int64_t utime = 0;
    Pose odom_from_keyframe = Pose::Identity();
    std::vector<TrackPoint> points;
    FlowPyramid pyramid;  ///< with derivatives
    Surface surface;
    std::vector<PlanarRegion> regions;
};

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
    bool degenerate = false;  ///< a direction is known from the guess only
};

/// How flow searches.
struct FlowSearch {
    const FlowPyramid* from = nullptr;
    const std::vector<cv::Point2f>* from_pixels = nullptr;  ///< one per point of the keyframe
    const std::vector<char>* usable = nullptr;              ///< points to start from; nullptr: all
    int levels = 3;
};

/// Flow from the keyframe (or another frame that saw its points) to the view, started at the guess; then the
/// pose from points, surfaces, planes and guess together. Nothing when too few points fit one motion.
std::optional<Track> track_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& view, const Guess& guess, const FlowSearch& search);

/// The pose from points that are already found: `pixels` of the keyframe's points with `found` set.
std::optional<Track> align_points(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                  const PreparedFrame& view, const Guess& guess,
                                  std::vector<cv::Point2f> pixels, const std::vector<char>& found);

/// The pose from depth alone: point-to-plane against the keyframe's surface and planes, from the guess.
/// Nothing when too little of the surface is seen again.
std::optional<Track> track_surface(const OdometryOptions& options, const LocalKeyframe& keyframe,
                                   const PreparedFrame& view, const Guess& guess);

/// A better guess from the whole image at coarse levels against the last frame, and from depth against the
/// keyframe's surface: for blur and motions that the prediction missed.
Guess coarse_guess(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& view,
                   const Guess& guess, const DenseReference& last, const Pose& keyframe_from_last);

/// The view's regions against the keyframe's at camera_from_keyframe: the sum over each region's points of
/// the squared distance to the keyframe's plane, exact from its moments. A plane counts as at most
/// `independent_points` points.
QuadraticTerm match_planes(std::span<const PlanarRegion> keyframe_regions,
                           std::span<const PlanarRegion> regions, const Pose& camera_from_keyframe,
                           const DepthNoise& noise, double independent_points);

}  // namespace planemap::odometry
