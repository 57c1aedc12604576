// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"

namespace planemap::map {

void add_flags(Flags& flags, MapOptions& options, const std::string& prefix) {
    flags.section("Map", prefix);
    flags.add("merge-angle-deg", options.merge_angle_deg,
              "largest angle between merged regions (paper section 2.3)");
    flags.add("merge-distance-m", options.merge_distance_m,
              "largest distance between their planes, where they are (section 2.3)");
    flags.add("merge-gap-m", options.merge_gap_m, "largest gap between their boxes (section 2.3)");
    flags.add("noise-base-m", options.noise.base_m, "depth noise: constant part, metres");
    flags.add("noise-quadratic-per-m", options.noise.quadratic_per_m,
              "depth noise: growth with distance squared, 1/m");
    flags.add("noise-offset-m", options.noise.offset_m, "depth noise: distance of least noise, metres");
    flags.add("pose-sigma-m", options.pose_sigma_m,
              "error of keyframe poses; below it, less sensor noise gains no weight");
    flags.add("agreement-m", options.agreement_m,
              "a view off its plane by much more than this (and the sensor's noise) loses weight");
    flags.add("outline-cell-m", options.outline_cell_m, "raster on which a plane's shape is collected");
    flags.add("outline-tolerance-m", options.outline_tolerance_m, "simplification of the outline");
    flags.add("outline-min-ring-m2", options.outline_min_ring_m2,
              "smaller parts and holes of an outline are left out");
    flags.add("outline-min-hits", options.outline_min_hits,
              "evidence a cell needs: 1 for a far view, up to 4 for a near one");
    flags.add("see-through-m", options.see_through_m,
              "a view past a cell by more than this (and 2 sigma) is evidence against it");
    flags.add("adjacency-gap-m", options.adjacency_gap_m,
              "planes meet where both outlines come this near to the common line");
    flags.add("adjacency-angle-deg", options.adjacency_angle_deg, "flatter pairs get no intersection line");
    flags.add("adjacency-length-m", options.adjacency_length_m, "shorter intersection lines are left out");
    flags.add("min-area-m2", options.min_area_m2, "smaller planes are kept, but are not in map()");
    flags.add("min-single-m2", options.min_single_m2, "the same for planes that only one keyframe saw");
    flags.add("min-keyframes", options.min_keyframes,
              "planes seen by fewer keyframes are kept, but are not in map()");
    flags.add("moved-m", options.moved_m, "keyframes that moved less than this");
    flags.add("moved-deg", options.moved_deg, "and turned less than this, do not cause a rebuild");
    flags.add("max-extent-m", options.max_extent_m, "a plane does not grow longer than this");
    flags.add("fold-after", options.fold_after,
              "keyframes older than so many newer ones are taken not to move any more: their regions are "
              "folded into the planes; 0: never");
    flags.add("threads", options.threads, "threads of a rebuild; they do not change the result");
}

}  // namespace planemap::map
