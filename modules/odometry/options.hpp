// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace planemap::odometry {

/// Options of Odometry. Lengths in metres and angles in radians unless a suffix says otherwise.
struct OdometryOptions {
    /// "planar": features tracked against keyframes, refined together with depth surfaces and planes.
    /// "paper": planar feature points only, matched frame to frame (paper section 2).
    std::string method = "planar";

    int max_points = 300;       ///< corners tracked per keyframe
    int cell_px = 20;           ///< one corner at most in each square of this side
    int corner_threshold = 20;  ///< FAST threshold; a dim image is tried again at a third of it
    double max_depth_spread =
        0.04;  ///< depth range around a feature, as a share of depth, to trust its depth

    int flow_window_px = 11;   ///< Lucas-Kanade window
    int flow_levels = 3;       ///< pyramid levels when the prediction is good
    int flow_wide_levels = 5;  ///< pyramid levels of the second chance
    int flow_iterations = 10;  ///< Lucas-Kanade steps a level

    double pixel_sigma_px = 1.0;     ///< of a tracked feature
    double depth_sigma_scale = 2.0;  ///< depth noise of a feature, in units of the sensor's noise model
    double loss_scale = 2.0;         ///< sigmas at which the heavy-tailed loss halves a residual's weight
    double inlier_sigmas = 3.0;      ///< a feature with a larger residual is an outlier
    int min_inliers = 15;            ///< fewer features, and the pose does not rest on features
    double min_inlier_share = 0.3;   ///< of the tracked features

    int surface_cell_px = 16;      ///< side of the depth cells a keyframe's surface is made of
    int surface_stride_px = 8;     ///< spacing of the depth samples of a frame
    double surface_gate_m = 0.04;  ///< samples further from the surface than this (and 3 sigma) are left out
    double surface_weight = 1.0;   ///< information of one sample relative to an independent one
    double plane_points = 3;       ///< independent points that a plane seen again counts as, at most
    double min_surface_share = 0.35;  ///< of the samples, for a pose that rests on depth alone

    double color_jitter_s = 0.003;       ///< sigma of the colour image's time against its stamp
    double acceleration = 4.0;           ///< of the camera, m/s^2: how far a pose may be from its prediction
    double angular_acceleration = 20.0;  ///< of the camera, rad/s^2
    double max_prediction_s = 0.2;       ///< the motion of the last frames is not carried on for longer

    double min_tracked_share = 0.55;  ///< fewer of a keyframe's points tracked: a new keyframe
    double max_translation_m = 0.4;   ///< from the keyframe: a new keyframe
    double max_rotation_rad = 0.5;    ///< from the keyframe: a new keyframe
    int local_keyframes = 8;          ///< recent keyframes that tracking may return to; 0: never

    int max_descriptors = 500;         ///< features a keyframe hands to loop closure
    int max_known_keyframes = 100;     ///< keyframes kept for relocalisation
    int relocalisation_tries = 4;      ///< keyframes matched in one lost frame
    int max_descriptor_distance = 64;  ///< bits in which matched descriptors may differ
    int max_lost_frames = 15;          ///< then a new keyframe begins, without an edge to the others

    std::uint64_t seed = 1;  ///< of RANSAC

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

}  // namespace planemap::odometry
