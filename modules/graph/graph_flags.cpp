// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

namespace planemap {

namespace {

void add_search_flags(Flags& flags, GraphOptions& options) {
    flags.add("max-features", options.max_features, "of a keyframe, kept for loop closure");
    flags.add("min-separation", options.min_separation,
              "keyframes between two that a loop closure may join, along one chain");
    flags.add("appearance-candidates", options.appearance_candidates,
              "keyframes tried for a new one because they look alike");
    flags.add("place-candidates", options.place_candidates,
              "keyframes tried because they should see the same place");
    flags.add("max-closures", options.max_closures, "accepted for one keyframe");
    flags.add("min-appearance", options.min_appearance,
              "share of the new keyframe's rare features that a candidate has too");
    flags.add("min-overlap", options.min_overlap, "share of points in view, for a candidate by place");
    flags.add("max-place-drift-m", options.max_place_drift_m,
              "with more drift between two keyframes, place says nothing");
}

void add_verification_flags(Flags& flags, GraphOptions& options) {
    flags.add("max-descriptor-distance", options.max_descriptor_distance,
              "bits in which two descriptors of one point may differ");
    flags.add("matching-ratio", options.matching_ratio, "best to second-best descriptor distance, at most");
    flags.add("noise-base-m", options.noise.base_m, "depth noise: constant part, metres");
    flags.add("noise-quadratic-per-m", options.noise.quadratic_per_m,
              "depth noise: growth with distance squared, 1/m");
    flags.add("noise-offset-m", options.noise.offset_m, "depth noise: distance of least noise, metres");
    flags.add("bearing-sigma", options.bearing_sigma, "of the features' points across their rays, radians");
    flags.add("min-inliers", options.min_inliers, "matched points that agree with a loop closure");
    flags.add("min-inlier-ratio", options.min_inlier_ratio, "of the matches");
    flags.add("min-visible-ratio", options.min_visible_ratio,
              "inliers, of the points that both views should see");
    flags.add("max-contradiction", options.max_contradiction,
              "share of plane samples that the other view saw through");
}

void add_redundancy_flags(Flags& flags, GraphOptions& options) {
    flags.add("max-alike", options.max_alike,
              "newer keyframes of the same place that look alike: an older one goes; 0: all stay");
    flags.add("max-place", options.max_place,
              "keyframes of one place, whatever they look like; the oldest goes");
    flags.add("place-share", options.place_share,
              "keyframes are of one place when they stand nearer than this share of the depth that they see");
    flags.add("place-rad", options.place_rad, "and are turned by less, radians");
    flags.add("min-alike-ratio", options.min_alike_ratio,
              "like points, of those that both should see, of views that look alike");
}

void add_drift_flags(Flags& flags, GraphOptions& options) {
    flags.add("surroundings-from-m", options.surroundings_from_m,
              "a loop closure that moves the newest keyframe by more must also fit what was seen around it");
    flags.add("drift-per-metre", options.drift_per_metre,
              "bound of odometry's drift: metres a metre of path");
    flags.add("drift-per-radian", options.drift_per_radian, "metres and radians a radian of turning");
    flags.add("drift-base-m", options.drift_base_m, "metres, on top");
    flags.add("drift-base-rad", options.drift_base_rad, "radians, on top");
    flags.add("max-lost-speed", options.max_lost_speed, "of the camera while odometry is lost, m/s");
}

void add_optimisation_flags(Flags& flags, GraphOptions& options) {
    flags.add("odometry-sigma-m", options.odometry_sigma_m,
              "added to each odometry edge's covariance: metres");
    flags.add("odometry-sigma-rad", options.odometry_sigma_rad, "and radians");
    flags.add("loop-sigma-m", options.loop_sigma_m, "added to each loop closure's covariance: metres");
    flags.add("loop-sigma-rad", options.loop_sigma_rad, "and radians");
    flags.add("landmark-angle-deg", options.landmark_angle_deg,
              "between a region and the landmark it is taken for");
    flags.add("landmark-distance-m", options.landmark_distance_m,
              "between a region and the landmark it is taken for");
    flags.add("landmark-gap-m", options.landmark_gap_m, "between their boxes");
    flags.add("landmark-sigma-m", options.landmark_sigma_m,
              "of a region's distance to its landmark, on top of the sensor's noise");
    flags.add("kernel-width", options.kernel_width, "Cauchy kernel of loop closures, standard deviations");
    flags.add("max-iterations", options.max_iterations, "of one optimisation");
    flags.add("optimise-every", options.optimise_every,
              "also without a closure, each so many keyframes; 0: never");
    flags.add("revision-m", options.revision_m, "movement of a keyframe that makes a new revision");
    flags.add("revision-rad", options.revision_rad, "movement of a keyframe that makes a new revision");
}

}  // namespace

void add_flags(Flags& flags, GraphOptions& options, const std::string& prefix) {
    flags.section("Graph", prefix);
    add_search_flags(flags, options);
    add_verification_flags(flags, options);
    add_redundancy_flags(flags, options);
    add_drift_flags(flags, options);
    add_optimisation_flags(flags, options);
}

}  // namespace planemap
