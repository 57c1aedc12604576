// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_options.hpp"

#include <cmath>
#include <string>

#include "core/validation.hpp"

namespace planemap {

namespace {

/// Names the fields of one GraphOptions that are out of range.
class Checker {
  public:
    explicit Checker(const GraphOptions& options) : o_(options) {}

    void check_search();
    void check_verification();
    void check_redundancy();
    void check_edges();
    void check_optimisation();
    void throw_if_any() const { errors_.throw_if_any(); }

  private:
    void count(int value, int least, const char* field) {
        errors_.require(value >= least, field, value, "at least " + std::to_string(least));
    }
    void positive(double value, const char* field) {
        errors_.require(std::isfinite(value) && value > 0, field, value, "finite and greater than 0");
    }
    void not_negative(double value, const char* field) {
        errors_.require(std::isfinite(value) && value >= 0, field, value, "finite and at least 0");
    }
    void share(double value, const char* field) {
        errors_.require(value >= 0 && value <= 1, field, value, "0 to 1");
    }

    const GraphOptions& o_;
    FieldErrors errors_{"graph options"};
};

void Checker::check_search() {
    count(o_.max_features, 1, "max_features");
    count(o_.min_separation, 1, "min_separation");
    count(o_.appearance_candidates, 0, "appearance_candidates");
    count(o_.place_candidates, 0, "place_candidates");
    count(o_.max_closures, 0, "max_closures");
    share(o_.min_appearance, "min_appearance");
    share(o_.min_overlap, "min_overlap");
    not_negative(o_.max_place_drift_m, "max_place_drift_m");
}

void Checker::check_verification() {
    errors_.require(o_.max_descriptor_distance >= 0 && o_.max_descriptor_distance <= 256,
                    "max_descriptor_distance", o_.max_descriptor_distance, "0 to 256");
    share(o_.matching_ratio, "matching_ratio");
    not_negative(o_.noise.base_m, "noise.base_m");
    not_negative(o_.noise.quadratic_per_m, "noise.quadratic_per_m");
    errors_.require(std::isfinite(o_.noise.offset_m), "noise.offset_m", o_.noise.offset_m, "finite");
    positive(o_.bearing_sigma, "bearing_sigma");
    count(o_.min_inliers, 3, "min_inliers");
    share(o_.min_inlier_ratio, "min_inlier_ratio");
    share(o_.min_visible_ratio, "min_visible_ratio");
    share(o_.max_contradiction, "max_contradiction");
}

void Checker::check_redundancy() {
    count(o_.max_alike, 0, "max_alike");
    count(o_.max_place, 1, "max_place");
    positive(o_.place_share, "place_share");
    positive(o_.place_rad, "place_rad");
    share(o_.min_alike_ratio, "min_alike_ratio");
}

void Checker::check_edges() {
    not_negative(o_.surroundings_from_m, "surroundings_from_m");
    not_negative(o_.drift_per_metre, "drift_per_metre");
    not_negative(o_.drift_per_radian, "drift_per_radian");
    not_negative(o_.drift_base_m, "drift_base_m");
    not_negative(o_.drift_base_rad, "drift_base_rad");
    not_negative(o_.max_lost_speed, "max_lost_speed");
    positive(o_.odometry_sigma_m, "odometry_sigma_m");
    positive(o_.odometry_sigma_rad, "odometry_sigma_rad");
    positive(o_.loop_sigma_m, "loop_sigma_m");
    positive(o_.loop_sigma_rad, "loop_sigma_rad");
}

void Checker::check_optimisation() {
    positive(o_.landmark_extent_m, "landmark_extent_m");
    positive(o_.landmark_angle_deg, "landmark_angle_deg");
    positive(o_.landmark_distance_m, "landmark_distance_m");
    not_negative(o_.landmark_gap_m, "landmark_gap_m");
    positive(o_.landmark_sigma_m, "landmark_sigma_m");
    positive(o_.landmark_trigger, "landmark_trigger");
    positive(o_.kernel_width, "kernel_width");
    count(o_.max_iterations, 1, "max_iterations");
    count(o_.optimise_every, 0, "optimise_every");
    positive(o_.revision_m, "revision_m");
    positive(o_.revision_rad, "revision_rad");
}

}  // namespace

void GraphOptions::validate() const {
    Checker checker(*this);
    checker.check_search();
    checker.check_verification();
    checker.check_redundancy();
    checker.check_edges();
    checker.check_optimisation();
    checker.throw_if_any();
}

}  // namespace planemap
