// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "core/option_list.hpp"
#include "places/matching.hpp"

namespace planemap::odometry {

/// Where motion priors are from, and how far they may be off; options_of() says what each is.
struct MotionPriorOptions {
    std::string channel;
    double sigma_m_per_m = 0.05, sigma_rad_per_rad = 0.05;
    double max_age_s = 0.2;
};

/// By the names of flags that stand alone. Refers to `options`, which must outlive it.
OptionList options_of(MotionPriorOptions& options);

/// Options of Odometry; options_of() says what each is.
struct OdometryOptions {
    std::string method = "planar";
    MotionPriorOptions motion;  ///< not in the list of options_of(OdometryOptions&): it has its own

    int max_points = 300;
    int cell_px = 20;
    int corner_threshold = 20;

    double pixel_sigma_px = 1.0;
    int min_inliers = 15;

    double color_jitter_s = 0.003;
    double acceleration = 4.0;
    double angular_acceleration = 20.0;

    double min_tracked_share = 0.55;
    double max_translation_m = 0.4;
    double max_rotation_rad = 0.5;
    int local_keyframes = 8;

    int max_descriptors = 500;
    int max_known_keyframes = 100;
    int relocalisation_tries = 4;
    int max_lost_frames = 15;

    std::uint64_t seed = 1;

    // Fixed: nobody can tell how to set these without reading the code.
    static constexpr double max_depth_spread = 0.04;   ///< depth range around a feature, as a share of depth,
                                                       ///< to trust its depth
    static constexpr int flow_window_px = 11;          ///< Lucas-Kanade window
    static constexpr int flow_levels = 3;              ///< pyramid levels when the prediction is good
    static constexpr int flow_wide_levels = 5;         ///< pyramid levels of the second chance
    static constexpr int flow_iterations = 10;         ///< Lucas-Kanade steps a level
    static constexpr double depth_sigma_scale = 2.0;   ///< depth noise of a feature, in units of the sensor's
    static constexpr double loss_scale = 2.0;          ///< sigmas at which the heavy-tailed loss halves a
                                                       ///< residual's weight
    static constexpr double inlier_sigmas = 3.0;       ///< a feature with a larger residual is an outlier
    static constexpr double min_inlier_share = 0.3;    ///< of the tracked features
    static constexpr int surface_cell_px = 16;         ///< side of the depth cells of a keyframe's surface
    static constexpr int surface_stride_px = 8;        ///< spacing of the depth samples of a frame
    static constexpr double surface_gate_m = 0.04;     ///< samples further from the surface than this (and 3
                                                       ///< sigma) are left out
    static constexpr double surface_weight = 1.0;      ///< information of a sample relative to an independent
                                                       ///< one
    static constexpr double plane_points = 3;          ///< independent points that a plane seen again counts
                                                       ///< as, at most
    static constexpr double min_surface_share = 0.35;  ///< of the samples, for a pose that rests on depth
                                                       ///< alone
    static constexpr double max_prediction_s = 0.2;  ///< the motion of the last frames is not carried on for
                                                     ///< longer
    static constexpr double stamp_sigma_s = 0.0096;  ///< by which all stamps of a sensor are late: any part
                                                     ///< of the 1/30 s that a frame takes to be exposed, read
                                                     ///< out and sent
    static constexpr int max_descriptor_distance =   ///< bits in which matched descriptors may differ
        places::MatchingOptions{}.max_distance;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(OdometryOptions& options);

}  // namespace planemap::odometry
