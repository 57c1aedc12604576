// SPDX-License-Identifier: BSD-3-Clause
#include "map/options.hpp"

namespace planemap::map {

OptionList options_of(MapOptions& options) {
    using enum Audience;
    OptionList list("Map");
    list.add(
        "rules", options.rules, {"surfaces", "paper"},
        "Which regions are one plane: by the merging rules of paper section 2.3 alone, or also planes that "
        "overlap, as far as poses and depth err and no views saw a step between them");
    list.add("merge_angle_deg", options.merge_angle_deg, {0, 45},
             "Largest angle between merged regions (paper section 2.3)");
    list.add("merge_distance_m", options.merge_distance_m, {0, 10},
             "Largest distance between the planes of merged regions, where the regions are (section 2.3)");
    list.add("merge_gap_m", options.merge_gap_m, {0, 100},
             "Largest gap between the boxes of merged regions (section 2.3)");
    list.add(
        "pose_sigma_m", options.pose_sigma_m, {1e-6, 10},
        "Standard deviation of keyframe poses; a view whose depth noise is smaller gains no weight by it");
    list.add("agreement_m", options.agreement_m, {1e-6, 100},
             "A view that lies off its plane by much more than this (and the sensor's noise) loses weight",
             kExpert);
    list.add("outline_cell_m", options.outline_cell_m, {0.005, 1},
             "Cell of the raster on which a plane's shape is collected");
    list.add("outline_tolerance_m", options.outline_tolerance_m, {0, 1},
             "By how much an outline may leave the shape that it simplifies");
    list.add("outline_min_ring_m2", options.outline_min_ring_m2, {0, 100},
             "Smaller parts and holes of an outline are left out", kExpert);
    list.add("see_through_m", options.see_through_m, {0.01, 100},
             "A view that sees past a plane's cell by more than this (and 2 sigmas of the sensor's noise) "
             "counts against the cell");
    list.add("adjacency_gap_m", options.adjacency_gap_m, {0, 10},
             "Two planes meet where both outlines come this near to their common line", kExpert);
    list.add("adjacency_angle_deg", options.adjacency_angle_deg, {1, 90},
             "Two planes at a smaller angle get no intersection line", kExpert);
    list.add("adjacency_length_m", options.adjacency_length_m, {0, 100},
             "Shorter intersection lines are left out", kExpert);
    list.add("min_area_m2", options.min_area_m2, {0, 1e6},
             "Smaller planes are left out of the map until they have grown");
    list.add("min_single_m2", options.min_single_m2, {0, 1e6},
             "Smaller planes that only one keyframe saw are left out of the map until they have grown");
    list.add("min_keyframes", options.min_keyframes, {1, 1e6},
             "Planes that fewer keyframes saw are left out of the map until more do");
    list.add("moved_m", options.moved_m, {0, 10},
             "A correction that moves no keyframe by more, and turns none beyond its limit, rebuilds nothing",
             kExpert);
    list.add("moved_deg", options.moved_deg, {0, 180},
             "A correction that turns no keyframe by more, and moves none beyond its limit, rebuilds nothing",
             kExpert);
    list.add("max_extent_m", options.max_extent_m, {1, 1000}, "A plane does not grow longer than this",
             kExpert);
    list.add("infer_hidden", options.infer_hidden,
             "Infer where floors, ceilings and walls go on behind what stands before them", kExpert);
    list.add("fold_after", options.fold_after, {0, 1e9},
             "Keyframes older than so many newer ones are taken not to move any more: their regions are "
             "folded into the planes; 0: never");
    list.add("threads", options.threads, {1, 64}, "Threads of a rebuild; they do not change the result",
             kExpert);
    return list;
}

void MapOptions::validate() const {
    check_options("MapOptions", *this);
}

}  // namespace planemap::map
