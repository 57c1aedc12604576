// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"

namespace planemap {

/// Options of PoseGraph.
struct GraphOptions {
    int max_features = 600;  ///< of a keyframe, kept for loop closure

    int min_separation = 8;          ///< keyframes between two that a loop closure may join, along one chain
    int appearance_candidates = 3;   ///< keyframes tried for a new one because they look alike
    int place_candidates = 3;        ///< keyframes tried because they should see the same place
    int max_closures = 2;            ///< accepted for one keyframe
    double min_appearance = 0.02;    ///< share of the new keyframe's rare features that a candidate has too
    double min_overlap = 0.3;        ///< share of points in view, for a candidate by place
    double max_place_drift_m = 1.0;  ///< with more drift between two keyframes, place says nothing

    int max_descriptor_distance = 64;  ///< bits in which two descriptors of one point may differ
    double matching_ratio = 0.85;      ///< best to second-best descriptor distance, at most
    DepthNoise noise;                  ///< of the features' points along their rays
    double bearing_sigma = 0.003;      ///< of the features' points across their rays, radians
    int min_inliers = 25;              ///< matched points that agree with a loop closure
    double min_inlier_ratio = 0.35;    ///< of the matches
    double min_visible_ratio = 0.12;   ///< inliers, of the points that both views should see
    double max_contradiction = 0.25;   ///< share of plane samples that the other view saw through

    int max_alike = 2;          ///< newer keyframes of the same place that look alike: an older one goes;
                                ///< 0: all stay
    int max_place = 8;          ///< keyframes of one place, whatever they look like; the oldest goes
    double place_share = 0.08;  ///< keyframes are of one place when they stand nearer than this share of the
                                ///< depth that they see,
    double place_rad = 0.17;    ///< and are turned by less
    double min_alike_ratio = 0.25;  ///< like points, of those that both should see, of views that look alike

    double surroundings_from_m = 0.3;  ///< a loop closure that moves the newest keyframe by more (metres plus
                                       ///< radians) must also fit what was seen around it

    double drift_per_metre = 0.05;   ///< bound of odometry's drift: metres a metre of path
    double drift_per_radian = 0.05;  ///< metres and radians a radian of turning
    double drift_base_m = 0.2;       ///< metres, on top
    double drift_base_rad = 0.2;     ///< radians, on top
    double max_lost_speed = 2.0;     ///< of the camera while odometry is lost, m/s

    double odometry_sigma_m = 0.005;    ///< added to each odometry edge's covariance: metres
    double odometry_sigma_rad = 0.005;  ///< and radians
    double loop_sigma_m = 0.010;        ///< added to each loop closure's covariance: metres
    double loop_sigma_rad = 0.005;      ///< and radians
    double landmark_extent_m =
        0.25;  ///< smaller regions are no landmarks; standard deviation of the shorter side
    double landmark_angle_deg = 8;      ///< between a region and the landmark it is taken for
    double landmark_distance_m = 0.06;  ///< between a region and the landmark it is taken for
    double landmark_gap_m = 0.5;        ///< between their boxes
    double landmark_sigma_m = 0.01;  ///< of a region's distance to its landmark, on top of the sensor's noise
    double landmark_trigger =
        2.0;  ///< standard deviations by which a keyframe's planes must disagree to optimise
    double kernel_width = 3.0;  ///< Cauchy kernel of loop closures, standard deviations
    int max_iterations = 30;    ///< of one optimisation
    int optimise_every = 0;     ///< also without a closure, each so many keyframes; 0: never
    double revision_m = 0.001, revision_rad = 0.0005;  ///< movement of a keyframe that makes a new revision

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

}  // namespace planemap
