// SPDX-License-Identifier: BSD-3-Clause
#include "graph/options.hpp"

namespace planemap::graph {

namespace {

void add_closure_options(OptionList& list, GraphOptions& options) {
    using enum Audience;
    list.add("max_features", options.max_features, at_least(1),
             "Features of a keyframe that are kept for loop closure", kExpert);
    list.add("min_separation", options.min_separation, at_least(1),
             "Keyframes between two that a loop closure may join, along one chain", kExpert);
    list.add("appearance_candidates", options.appearance_candidates, at_least(0),
             "Keyframes that are tried for a loop closure with a new one because they look alike", kExpert);
    list.add(
        "place_candidates", options.place_candidates, at_least(0),
        "Keyframes that are tried for a loop closure with a new one because they should see the same place",
        kExpert);
    list.add("max_closures", options.max_closures, at_least(0),
             "Loop closures that are accepted for one keyframe; 0: none");
    list.add("max_place_drift_m", options.max_place_drift_m, at_least(0),
             "Keyframes between which more drift is possible are not tried for a loop closure for their "
             "places alone",
             kExpert);
    list.add("matching_ratio", options.matching_ratio, kShare,
             "Largest ratio of the best to the second-best descriptor distance of a match", kExpert);
    list.add("min_inliers", options.min_inliers, at_least(3),
             "Matched points that must agree with a loop closure");
    list.add("min_inlier_ratio", options.min_inlier_ratio, kShare,
             "Share of the matched points that must agree with a loop closure", kExpert);
    list.add("surroundings_from_m", options.surroundings_from_m, at_least(0),
             "A loop closure that moves the newest keyframe by more (metres plus radians) must also fit what "
             "was seen around it",
             kExpert);
}

void add_place_options(OptionList& list, GraphOptions& options) {
    list.add("max_alike", options.max_alike, at_least(0),
             "A keyframe goes when so many newer ones of its place look like it; 0: all stay");
    list.add("max_place", options.max_place, at_least(1),
             "Keyframes of one place that stay, whatever they look like; the oldest goes");
}

void add_drift_options(OptionList& list, GraphOptions& options) {
    using enum Audience;
    list.add("drift_per_metre", options.drift_per_metre, at_least(0, "m/m"),
             "Bound of odometry's drift, for each metre of path", kExpert);
    list.add("drift_per_radian", options.drift_per_radian, at_least(0),
             "Bound of odometry's drift, metres and radians, for each radian that the camera turns", kExpert);
    list.add("drift_base_m", options.drift_base_m, at_least(0),
             "Bound of odometry's drift, on top of what path and turning add", kExpert);
    list.add("drift_base_rad", options.drift_base_rad, at_least(0),
             "Bound of odometry's drift in angle, on top of what path and turning add", kExpert);
    list.add("max_lost_speed", options.max_lost_speed, at_least(0, "m/s"),
             "Of the camera while odometry is lost", kExpert);
    list.add("odometry_sigma_m", options.odometry_sigma_m, greater_than(0),
             "Standard deviation that each odometry edge has beyond its own covariance", kExpert);
    list.add("odometry_sigma_rad", options.odometry_sigma_rad, greater_than(0),
             "Standard deviation of angle that each odometry edge has beyond its own covariance", kExpert);
    list.add("loop_sigma_m", options.loop_sigma_m, greater_than(0),
             "Standard deviation that each loop closure has beyond its own covariance", kExpert);
    list.add("loop_sigma_rad", options.loop_sigma_rad, greater_than(0),
             "Standard deviation of angle that each loop closure has beyond its own covariance", kExpert);
}

void add_landmark_options(OptionList& list, GraphOptions& options) {
    using enum Audience;
    list.add("landmark_angle_deg", options.landmark_angle_deg, greater_than(0),
             "Largest angle between a region and the landmark that it is taken for", kExpert);
    list.add("landmark_distance_m", options.landmark_distance_m, greater_than(0),
             "Largest distance between the planes of a region and of the landmark that it is taken for");
    list.add("landmark_gap_m", options.landmark_gap_m, at_least(0),
             "Largest gap between the boxes of a region and of the landmark that it is taken for", kExpert);
    list.add("landmark_sigma_m", options.landmark_sigma_m, greater_than(0),
             "Standard deviation of a region's distance to its landmark, on top of the sensor's noise",
             kExpert);
}

}  // namespace

OptionList options_of(GraphOptions& options) {
    OptionList list("Graph");
    add_closure_options(list, options);
    add_place_options(list, options);
    add_drift_options(list, options);
    add_landmark_options(list, options);
    list.add("optimise_every", options.optimise_every, at_least(0),
             "Keyframes after which the graph is optimised though no loop was closed; 0: never");
    return list;
}

void GraphOptions::validate() const {
    check_options("graph options", *this);
}

}  // namespace planemap::graph
