// SPDX-License-Identifier: BSD-3-Clause
#include "map/rules.hpp"

#include "core/geometry/angle.hpp"

namespace planemap::map {

MergeRules merge_rules(const MapOptions& options) {
    return {radians(options.merge_angle_deg), options.merge_distance_m, options.merge_gap_m};
}

std::optional<SurfaceRules> surface_rules(const MapOptions& options) {
    if (!options.unites_surfaces()) return std::nullopt;
    return SurfaceRules{.pose_sigma_m = options.pose_sigma_m};
}

ObservationModel observation_model(const MapOptions& options) {
    return {options.pose_sigma_m, options.agreement_m};
}

DerivationRules derivation_rules(const MapOptions& options) {
    // A tooth has two corners that enclose half of it each.
    return {{MapOptions::outline_min_support, options.outline_min_ring_m2, options.outline_tolerance_m,
             0.5 * options.outline_min_ring_m2},
            options.min_area_m2,
            options.min_single_m2,
            options.min_keyframes};
}

AdjacencyRules adjacency_rules(const MapOptions& options) {
    constexpr double kCells = 1.5;  // by which a shape that is drawn in cells, and closed, errs
    return {options.adjacency_gap_m, radians(options.adjacency_angle_deg), options.adjacency_length_m,
            kCells * options.outline_cell_m};
}

InferenceRules inference_rules(const MapOptions& options) {
    return {options.infer_hidden, options.outline_cell_m, options.outline_tolerance_m, options.min_area_m2};
}

}  // namespace planemap::map
