// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/geometry/plane_intersection.hpp"
#include "core/geometry/same_plane.hpp"
#include "core/option_list.hpp"

namespace planemap::map {

/// Options of PlaneMapper; options_of() says what each is.
struct MapOptions {
    std::string rules = "surfaces";
    double merge_angle_deg = kSamePlane_deg;
    double merge_distance_m = kSamePlaneDistance_m;
    double merge_gap_m = kSamePlaneGap_m;

    double pose_sigma_m = 0.02;
    double agreement_m = 0.01;

    double outline_cell_m = 0.025;
    double outline_tolerance_m = 0.04;
    double outline_min_ring_m2 = 0.01;
    double see_through_m = 0.05;

    double adjacency_gap_m = 0.15;
    double adjacency_angle_deg = kParallel_deg;
    double adjacency_length_m = 0.25;

    double min_area_m2 = 0.05;
    double min_single_m2 = 0.25;
    int min_keyframes = 1;

    double moved_m = 0.002;
    double moved_deg = 0.05;
    double max_extent_m = 200;
    bool infer_hidden = true;
    int fold_after = 0;
    int threads = 2;

    /// Fixed: the support that a cell of an outline needs; a far view gives 1, a near one up to 4.
    static constexpr int outline_min_support = 1;

    /// Whether planes that say one surface twice become one, see unite_surfaces().
    bool unites_surfaces() const { return rules == "surfaces"; }

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(MapOptions& options);

}  // namespace planemap::map
