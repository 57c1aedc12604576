// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation_shell.hpp"

namespace planemap::segmentation {

void add_flags(Flags& flags, SegmentationOptions& options, const std::string& prefix) {
    flags.section("Segmentation", prefix);
    flags.add("method", options.method, "'cells', or 'ransac' for the paper's method");
    flags.add("seed", options.seed, "of the random samples of 'ransac'");
    flags.add("cells-min-region-fraction", options.cells.min_region_fraction,
              "smallest region as a share of the image's pixels");
    flags.add("cells-min-fill", options.cells.min_fill,
              "share of a cell's pixels that must be valid for a fit");
    flags.add("cells-planarity-sigmas", options.cells.planarity_sigmas,
              "largest RMS of a planar cell, in sigmas of the depth noise there");
    flags.add("cells-lateral-px", options.cells.lateral_px,
              "standard deviation of where a reading was taken, pixels");
    flags.add("cells-step-m", options.cells.step_m,
              "largest step between neighbouring cells of one plane, metres");
    flags.add("cells-step-sigmas", options.cells.step_sigmas,
              "largest step between neighbouring cells of one plane, in sigmas of the depth noise there; the "
              "larger of both counts");
    flags.add("cells-grow-m", options.cells.grow_m,
              "largest mean distance of a cell to its region's plane, metres");
    flags.add("cells-grow-sigmas", options.cells.grow_sigmas,
              "largest mean distance of a cell to its region's plane, in sigmas of the depth noise there; "
              "the larger of both counts");
    flags.add("cells-grow-angle-deg", options.cells.grow_angle_deg,
              "largest angle between cell and region, beyond the cell's own error");
    flags.add("cells-merge-m", options.cells.merge_m,
              "by how much two regions may leave their common plane (RMS), metres");
    flags.add("cells-merge-sigmas", options.cells.merge_sigmas,
              "by how much two regions may leave their common plane (RMS), in sigmas of the depth noise "
              "there; the larger of both counts");
    flags.add("cells-merge-angle-deg", options.cells.merge_angle_deg,
              "largest angle between two regions to be merged");
    flags.add("cells-bend-deg", options.cells.bend_deg,
              "a region that turns by more from end to end is curved: no plane");
    flags.add("cells-thickness-m", options.cells.thickness_m,
              "largest distance of a pixel to its region's plane, metres");
    flags.add("cells-thickness-sigmas", options.cells.thickness_sigmas,
              "largest distance of a pixel to its region's plane, in sigmas of the depth noise there; the "
              "larger of both counts");
    flags.add("ransac-thickness-m", options.ransac.thickness_m,
              "largest distance of an inlier to its plane, metres");
    flags.add("ransac-min-inliers", options.ransac.min_inliers,
              "smallest region, counted in subsampled points as the paper does");
    flags.add("ransac-max-planes", options.ransac.max_planes, "regions per frame; the paper's k");
    flags.add("ransac-subsampling", options.ransac.subsampling,
              "every n-th row and column is used: 1 to 16 (the paper: 1, 2, 4)");
    flags.add("ransac-max-iterations", options.ransac.max_iterations, "RANSAC trials per plane");
    flags.add("ransac-probability", options.ransac.probability,
              "stop early when a sample without outliers was drawn this probably");
}

}  // namespace planemap::segmentation
