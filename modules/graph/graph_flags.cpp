// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"
#include "messages/flags.hpp"

namespace planemap {

void add_flags(CLI::App& app, GraphOptions& options, const std::string& prefix) {
    FlagAdder add(app, prefix, "Graph");
    add("max-features", options.max_features, "of a keyframe, kept for loop closure");
    add("min-separation", options.min_separation,
        "keyframes between two that a loop closure may join, along one chain");
    add("appearance-candidates", options.appearance_candidates,
        "keyframes tried for a new one because they look alike");
    add("place-candidates", options.place_candidates,
        "keyframes tried because they should see the same place");
    add("max-closures", options.max_closures, "accepted for one keyframe");
    add("min-appearance", options.min_appearance,
        "share of the new keyframe's rare features that a candidate has too");
    add("min-overlap", options.min_overlap, "share of points in view, for a candidate by place");
    add("max-place-drift-m", options.max_place_drift_m,
        "with more drift between two keyframes, place says nothing");
    add("max-descriptor-distance", options.max_descriptor_distance,
        "bits in which two descriptors of one point may differ");
    add("matching-ratio", options.matching_ratio, "best to second-best descriptor distance, at most");
    add("noise-base-m", options.noise.base_m, "depth noise: constant part, metres");
    add("noise-quadratic-per-m", options.noise.quadratic_per_m,
        "depth noise: growth with distance squared, 1/m");
    add("noise-offset-m", options.noise.offset_m, "depth noise: distance of least noise, metres");
    add("bearing-sigma", options.bearing_sigma, "of the features' points across their rays, radians");
    add("min-inliers", options.min_inliers, "matched points that agree with a loop closure");
    add("min-inlier-ratio", options.min_inlier_ratio, "of the matches");
    add("min-visible-ratio", options.min_visible_ratio, "inliers, of the points that both views should see");
    add("max-contradiction", options.max_contradiction,
        "share of plane samples that the other view saw through");
    add("drift-per-metre", options.drift_per_metre, "bound of odometry's drift: metres a metre of path");
    add("drift-per-radian", options.drift_per_radian, "metres and radians a radian of turning");
    add("drift-base-m", options.drift_base_m, "metres, on top");
    add("drift-base-rad", options.drift_base_rad, "radians, on top");
    add("max-lost-speed", options.max_lost_speed, "of the camera while odometry is lost, m/s");
    add("odometry-sigma-m", options.odometry_sigma_m, "added to each odometry edge's covariance");
    add("odometry-sigma-rad", options.odometry_sigma_rad, "added to each odometry edge's covariance");
    add("loop-sigma-m", options.loop_sigma_m, "added to each loop closure's covariance");
    add("loop-sigma-rad", options.loop_sigma_rad, "added to each loop closure's covariance");
    add("kernel-width", options.kernel_width, "Cauchy kernel of loop closures, standard deviations");
    add("max-iterations", options.max_iterations, "of one optimisation");
    add("optimise-every", options.optimise_every, "also without a closure, each so many keyframes; 0: never");
    add("revision-m", options.revision_m, "movement of a keyframe that makes a new revision");
    add("revision-rad", options.revision_rad, "movement of a keyframe that makes a new revision");
}

}  // namespace planemap
