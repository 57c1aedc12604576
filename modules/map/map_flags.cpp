// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_shell.hpp"
#include "messages/flags.hpp"

namespace planemap {

void add_flags(CLI::App& app, MapOptions& options, const std::string& prefix) {
    FlagAdder add(app, prefix, "Map");
    add("merge-angle-deg", options.merge_angle_deg,
        "largest angle between merged regions (paper section 2.3)");
    add("merge-distance-m", options.merge_distance_m,
        "largest distance between their planes, where they are (section 2.3)");
    add("merge-gap-m", options.merge_gap_m, "largest gap between their boxes (section 2.3)");
    add("noise-base-m", options.noise.base_m, "depth noise: constant part, metres");
    add("noise-quadratic-per-m", options.noise.quadratic_per_m,
        "depth noise: growth with distance squared, 1/m");
    add("noise-offset-m", options.noise.offset_m, "depth noise: distance of least noise, metres");
    add("pose-sigma-m", options.pose_sigma_m,
        "error of keyframe poses; below it, less sensor noise gains no weight");
    add("outline-cell-m", options.outline_cell_m, "raster on which a plane's shape is collected");
    add("outline-tolerance-m", options.outline_tolerance_m, "simplification of the outline");
    add("outline-min-ring-m2", options.outline_min_ring_m2,
        "smaller parts and holes of an outline are left out");
    add("outline-min-views", options.outline_min_views, "keyframe regions that must have covered a cell");
    add("adjacency-gap-m", options.adjacency_gap_m,
        "planes meet where both outlines come this near to the common line");
    add("adjacency-angle-deg", options.adjacency_angle_deg, "flatter pairs get no intersection line");
    add("adjacency-length-m", options.adjacency_length_m, "shorter intersection lines are left out");
    add("min-area-m2", options.min_area_m2, "smaller planes are kept, but are not in map()");
    add("min-keyframes", options.min_keyframes,
        "planes seen by fewer keyframes are kept, but are not in map()");
    add("moved-m", options.moved_m, "keyframes that moved less than this");
    add("moved-deg", options.moved_deg, "and turned less than this, do not cause a rebuild");
    add("max-extent-m", options.max_extent_m, "a plane does not grow longer than this");
}

}  // namespace planemap
