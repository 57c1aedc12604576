// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/option_list.hpp"
#include "places/verification_options.hpp"

namespace planemap::graph {

/// Options of PoseGraph; options_of() says what each is.
struct GraphOptions {
    int max_features = 600;

    int min_separation = 8;
    int appearance_candidates = 3;
    int place_candidates = 3;
    int max_closures = 2;
    double max_place_drift_m = 1.0;
    double matching_ratio = places::MatchingOptions{}.ratio;
    int min_inliers = places::VerificationOptions{}.min_inliers;
    double min_inlier_ratio = places::VerificationOptions{}.min_inlier_ratio;
    double surroundings_from_m = 0.3;

    int max_alike = 2;
    int max_place = 8;

    double drift_per_metre = 0.05;
    double drift_per_radian = 0.05;
    double drift_base_m = 0.2;
    double drift_base_rad = 0.2;
    double max_lost_speed = 2.0;

    double odometry_sigma_m = 0.005;
    double odometry_sigma_rad = 0.005;
    double loop_sigma_m = 0.010;
    double loop_sigma_rad = 0.005;
    double landmark_angle_deg = 8;
    double landmark_distance_m = 0.06;
    double landmark_gap_m = 0.5;
    double landmark_sigma_m = 0.005;
    int optimise_every = 0;

    // Fixed: nobody can tell how to set these without reading the code.
    static constexpr double min_appearance = 0.02;  ///< share of the new keyframe's rare features that a
                                                    ///< candidate for a loop closure has too
    static constexpr double min_overlap = 0.3;      ///< share of points in view, for a candidate by place
    static constexpr double max_contradiction =     ///< share of plane samples that the other view saw
        places::VerificationOptions{}.max_contradiction;  ///< through
    static constexpr double place_share = 0.08;  ///< keyframes are of one place when they stand nearer than
                                                 ///< this share of the depth that they see,
    static constexpr double place_rad = 0.17;    ///< and are turned by less
    static constexpr double min_alike_ratio = 0.25;  ///< like points, of those that both should see, of views
                                                     ///< that look alike
    static constexpr double landmark_extent_m = 0.1;  ///< smaller regions are no landmarks; standard
                                                      ///< deviation of the shorter side
    static constexpr double landmark_trigger = 2.0;   ///< standard deviations by which a keyframe's planes
                                                      ///< must disagree to optimise
    static constexpr double kernel_width = 3.0;       ///< Cauchy kernel of loop closures, standard deviations
    static constexpr int max_iterations = 30;         ///< of one optimisation
    static constexpr double revision_m = 0.001, revision_rad = 0.0005;  ///< movement of a keyframe that makes
                                                                        ///< a new revision

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(GraphOptions& options);

}  // namespace planemap::graph
