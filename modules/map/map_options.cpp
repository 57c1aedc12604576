// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_options.hpp"

#include "core/validation.hpp"

namespace planemap::map {

void MapOptions::validate() const {
    FieldErrors errors("MapOptions");
    const auto in = [&](const char* field, double value, double low, double high, const char* allowed) {
        errors.require(value >= low && value <= high, field, value, allowed);
    };
    in("merge_angle_deg", merge_angle_deg, 0, 45, "0 to 45");
    in("merge_distance_m", merge_distance_m, 0, 10, "0 to 10");
    in("merge_gap_m", merge_gap_m, 0, 100, "0 to 100");
    in("noise.base_m", noise.base_m, 0, 1, "0 to 1");
    in("noise.quadratic_per_m", noise.quadratic_per_m, 0, 1, "0 to 1");
    in("noise.offset_m", noise.offset_m, -100, 100, "-100 to 100");
    in("pose_sigma_m", pose_sigma_m, 1e-6, 10, "1e-6 to 10");
    in("agreement_m", agreement_m, 1e-6, 100, "1e-6 to 100");
    in("outline_cell_m", outline_cell_m, 0.005, 1, "0.005 to 1");
    in("outline_tolerance_m", outline_tolerance_m, 0, 1, "0 to 1");
    in("outline_min_ring_m2", outline_min_ring_m2, 0, 100, "0 to 100");
    in("outline_min_hits", outline_min_hits, 1, 15, "1 to 15");
    in("see_through_m", see_through_m, 0.01, 100, "0.01 to 100");
    in("adjacency_gap_m", adjacency_gap_m, 0, 10, "0 to 10");
    in("adjacency_angle_deg", adjacency_angle_deg, 1, 90, "1 to 90");
    in("adjacency_length_m", adjacency_length_m, 0, 100, "0 to 100");
    in("min_area_m2", min_area_m2, 0, 1e6, "0 to 1e6");
    in("min_single_m2", min_single_m2, 0, 1e6, "0 to 1e6");
    in("min_keyframes", min_keyframes, 1, 1e6, "1 to 1e6");
    in("moved_m", moved_m, 0, 10, "0 to 10");
    in("moved_deg", moved_deg, 0, 180, "0 to 180");
    in("max_extent_m", max_extent_m, 1, 1000, "1 to 1000");
    in("fold_after", fold_after, 0, 1e9, "0 to 1e9");
    in("threads", threads, 1, 64, "1 to 64");
    errors.throw_if_any();
}

}  // namespace planemap::map
