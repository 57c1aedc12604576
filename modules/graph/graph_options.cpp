// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include "core/validation.hpp"
#include "graph/graph.hpp"

namespace planemap {

void GraphOptions::validate() const {
    FieldErrors errors("graph options");
    const auto count = [&](int value, int least, const char* field) {
        errors.require(value >= least, field, value, "at least " + std::to_string(least));
    };
    const auto positive = [&](double value, const char* field) {
        errors.require(std::isfinite(value) && value > 0, field, value, "finite and greater than 0");
    };
    const auto not_negative = [&](double value, const char* field) {
        errors.require(std::isfinite(value) && value >= 0, field, value, "finite and at least 0");
    };
    const auto share = [&](double value, const char* field) {
        errors.require(value >= 0 && value <= 1, field, value, "0 to 1");
    };
    count(max_features, 1, "max_features");
    count(min_separation, 1, "min_separation");
    count(appearance_candidates, 0, "appearance_candidates");
    count(place_candidates, 0, "place_candidates");
    count(max_closures, 0, "max_closures");
    share(min_appearance, "min_appearance");
    share(min_overlap, "min_overlap");
    not_negative(max_place_drift_m, "max_place_drift_m");
    errors.require(max_descriptor_distance >= 0 && max_descriptor_distance <= 256, "max_descriptor_distance",
                   max_descriptor_distance, "0 to 256");
    share(matching_ratio, "matching_ratio");
    not_negative(noise.base_m, "noise.base_m");
    not_negative(noise.quadratic_per_m, "noise.quadratic_per_m");
    errors.require(std::isfinite(noise.offset_m), "noise.offset_m", noise.offset_m, "finite");
    positive(bearing_sigma, "bearing_sigma");
    count(min_inliers, 3, "min_inliers");
    share(min_inlier_ratio, "min_inlier_ratio");
    share(min_visible_ratio, "min_visible_ratio");
    share(max_contradiction, "max_contradiction");
    count(max_alike, 0, "max_alike");
    count(max_place, 1, "max_place");
    positive(place_share, "place_share");
    positive(place_rad, "place_rad");
    share(min_alike_ratio, "min_alike_ratio");
    not_negative(surroundings_from_m, "surroundings_from_m");
    not_negative(drift_per_metre, "drift_per_metre");
    not_negative(drift_per_radian, "drift_per_radian");
    not_negative(drift_base_m, "drift_base_m");
    not_negative(drift_base_rad, "drift_base_rad");
    not_negative(max_lost_speed, "max_lost_speed");
    positive(odometry_sigma_m, "odometry_sigma_m");
    positive(odometry_sigma_rad, "odometry_sigma_rad");
    positive(loop_sigma_m, "loop_sigma_m");
    positive(loop_sigma_rad, "loop_sigma_rad");
    positive(landmark_extent_m, "landmark_extent_m");
    positive(landmark_angle_deg, "landmark_angle_deg");
    positive(landmark_distance_m, "landmark_distance_m");
    not_negative(landmark_gap_m, "landmark_gap_m");
    positive(landmark_sigma_m, "landmark_sigma_m");
    positive(landmark_trigger, "landmark_trigger");
    positive(kernel_width, "kernel_width");
    count(max_iterations, 1, "max_iterations");
    count(optimise_every, 0, "optimise_every");
    positive(revision_m, "revision_m");
    positive(revision_rad, "revision_rad");
    errors.throw_if_any();
}

}  // namespace planemap
