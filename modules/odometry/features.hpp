// SPDX-License-Identifier: BSD-3-Clause
// Features of one frame and their 3D points.
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "odometry/options.hpp"

namespace planemap::odometry {

/// The image as OpenCV sees it, without a copy; valid while the image lives. OpenCV does not write to it.
cv::Mat as_mat(const GrayImage& gray);

/// Mean depth of the 3x3 readings around a pixel, metres; 0 when the 5x5 readings around it are not sound:
/// too few, out of the sensor's range, or spread over more than `max_spread` of their depth and the noise (an
/// edge). `depth` is registered to the colour camera.
double sound_depth(const DepthImage& depth, const CameraInfo& info, const Eigen::Vector2d& pixel,
                   double max_spread);

struct CornerOptions {
    int max_corners;
    int cell_px;              ///< at most one corner in each square of this side
    int threshold;            ///< FAST
    double max_depth_spread;  ///< see sound_depth()
};

/// What odometry's options say of them.
CornerOptions corner_options(const OdometryOptions& options);

/// The strongest FAST corner with sound depth of each cell, strongest cells first, at most max_corners.
std::vector<cv::Point2f> select_corners(const GrayImage& gray, const DepthImage& depth,
                                        const CameraInfo& info, const CornerOptions& options);

/// ORB features with sound depth, at most max_features, best first. Points in the camera frame.
std::vector<Feature> describe(const GrayImage& gray, const DepthImage& depth, const CameraInfo& info,
                              int max_features, double max_depth_spread);

/// Index of the region that a point lies on (within its noise of the plane and 2 cm of the outline), the
/// nearest plane first; -1: none.
int region_of(std::span<const PlanarRegion> regions, const Eigen::Vector3d& point, double depth_sigma);

/// Where the ray through the point meets the plane: the planar feature point of paper section 2.2, kept on
/// its pixel. The point itself when the ray grazes the plane.
Eigen::Vector3d regularised(const Plane& plane, const Eigen::Vector3d& point);

/// Mutual nearest neighbours within max_distance bits, whose second-best is clearly worse: (index in a, in
/// b).
std::vector<std::pair<int, int>> match_descriptors(std::span<const Feature> a, std::span<const Feature> b,
                                                   int max_distance);

}  // namespace planemap::odometry
