// SPDX-License-Identifier: BSD-3-Clause
// The pose of a camera against a keyframe from feature points, surfaces, planes and a prediction.
#pragma once

#include <span>
#include <vector>

#include "core/camera.hpp"

namespace planemap::odometry {

/// A keyframe's point seen in the current image.
struct PointTerm {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< keyframe camera frame, metres
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< where the current colour image shows it
    double pixel_sigma = 1;                           ///< pixels
    double inverse_depth = 0;        ///< 1 / depth at that pixel in the current depth image, 1/m; 0: unknown
    double inverse_depth_sigma = 1;  ///< of inverse_depth against the point's, 1/m
    /// By how much `point` would move for a second more of readout, m/s.
    Eigen::Vector3d point_per_readout = Eigen::Vector3d::Zero();
};

/// A cost 0.5 x' information x + gradient' x in the small motion x of the camera about `at`:
/// camera_from_keyframe = pose_from_twist(x) * at.
struct QuadraticTerm {
    Pose at = Pose::Identity();  ///< camera_from_keyframe
    Matrix6d information = Matrix6d::Zero();
    Twist gradient = Twist::Zero();
    bool is_prior = false;  ///< known beforehand, as well as its information says; else measured
};

/// Measurements of one tile of the image err together, those of different tiles each by themselves: what
/// errors of lens, depth and moments of exposure do to neighbours is alike.
inline constexpr int kTileColumns = 4, kTileRows = 3, kTiles = kTileColumns * kTileRows;
/// The tile of a pixel; of one outside, the nearest.
int tile_of(const PinholeCamera& camera, double u, double v);

/// What align() minimises. The unknowns are camera_from_keyframe at the depth image's time and the time from
/// the depth image to the colour image; features are seen at the colour image's time. With a rolling shutter
/// an image's time is that of its middle row, and others are later or earlier (see row_share()).
struct Alignment {
    PinholeCamera camera;
    std::span<const PointTerm> points;
    std::vector<QuadraticTerm> quadratics;
    Twist velocity = Twist::Zero();  ///< d/dt of the camera: camera(t + s) = pose_from_twist(s v) camera(t)
    double color_offset_s = 0;       ///< expected time of the colour image after the depth image
    double color_offset_sigma_s = 0.01;
    double readout_s = 0;      ///< from the first row to the last, of both images; 0: global shutter
    double loss_scale = 2;     ///< sigmas at which the loss halves a residual's weight (Student-t like)
    double inlier_sigmas = 3;  ///< residuals beyond are outliers in the result
};

struct AlignmentResult {
    Pose camera_from_keyframe = Pose::Identity();
    double color_offset_s = 0;
    Matrix6d information = Matrix6d::Zero();  ///< of the small motion x, points and quadratics together
    /// Of the gradient by x: how far apart tiles of points and measured quadratics pull, as they are found to
    /// at the solution; as large as the information where errors are independent and as large as assumed.
    Matrix6d scatter = Matrix6d::Zero();
    std::vector<char> inlier;  ///< one per point
    int inliers = 0;
    double residual_px = 0;  ///< RMS reprojection error of the inliers, pixels
    /// Cost of another readout r, with pose and offset at their best for it:
    /// 0.5 readout_information (r - readout_s)^2 + readout_gradient (r - readout_s).
    double readout_information = 0, readout_gradient = 0;
    bool converged = false;  ///< the last step was small and all values are finite
};

/// Of x, if errors are independent and as large as assumed: the inverse information.
Matrix6d assumed_covariance(const AlignmentResult& result);

/// What the residuals say of x beside their assumed sizes: the assumed covariance, and, added to it, the
/// cluster-robust (sandwich) covariance (White 1980, Liang and Zeger 1986) of errors that hang together.
Matrix6d covariance_of(const AlignmentResult& result);

/// Gauss-Newton with a heavy-tailed weight on the points, from `initial`.
AlignmentResult align(const Alignment& alignment, const Pose& initial, int max_iterations = 20);

/// Residuals of one point in sigmas (u, v, inverse depth; the last is 0 when unknown) when it is at p_camera,
/// and their derivative by x (see QuadraticTerm). False when the point is behind the camera.
bool point_residual(const PinholeCamera& camera, const PointTerm& term, const Eigen::Vector3d& p_camera,
                    Eigen::Vector3d& residual, Eigen::Matrix<double, 3, 6>* jacobian = nullptr);

/// When row v of an image is seen, as a share of the readout after the image's time: -0.5 to 0.5.
inline double row_share(const PinholeCamera& camera, double v) {
    return (v + 0.5) / camera.height - 0.5;
}

}  // namespace planemap::odometry
