// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation.hpp"

namespace planemap::segmentation {

OptionList options_of(CellOptions& options) {
    using enum Audience;
    OptionList list("Segmentation by cells");
    list.add("min_region_fraction", options.min_region_fraction, kShare,
             "Smallest region as a share of the image's pixels");
    list.add("grow_m", options.grow_m, greater_than(0),
             "Largest mean distance of a cell to its region's plane; or the limit in sigmas of the noise, if "
             "that is more",
             kExpert);
    list.add("grow_sigmas", options.grow_sigmas, greater_than(0),
             "Largest mean distance of a cell to its region's plane, in sigmas of the depth noise there; or "
             "the fixed limit, if that is more",
             kExpert);
    list.add(
        "merge_m", options.merge_m, greater_than(0),
        "By how much (RMS) two regions to be merged may leave their common plane; or the limit in sigmas "
        "of the noise, if that is more",
        kExpert);
    list.add(
        "merge_sigmas", options.merge_sigmas, greater_than(0),
        "By how much (RMS) two regions to be merged may leave their common plane, in sigmas of the depth "
        "noise there; or the fixed limit, if that is more",
        kExpert);
    list.add("merge_angle_deg", options.merge_angle_deg, between(0, 90),
             "Largest angle between two regions to be merged");
    list.add("bend_deg", options.bend_deg, between(0, 90),
             "A region that turns by more from end to end is curved, and no plane", kExpert);
    list.add(
        "thickness_m", options.thickness_m, greater_than(0),
        "Largest distance of a pixel to its region's plane; or the limit in sigmas of the noise, if that "
        "is more");
    list.add("thickness_sigmas", options.thickness_sigmas, greater_than(0),
             "Largest distance of a pixel to its region's plane, in sigmas of the depth noise there; or "
             "the fixed limit, if that is more",
             kExpert);
    return list;
}

OptionList options_of(RansacOptions& options) {
    using enum Audience;
    OptionList list("Segmentation by RANSAC");
    list.add("thickness_m", options.thickness_m, greater_than(0),
             "Largest distance of an inlier to its plane");
    list.add("min_inliers", options.min_inliers, at_least(3),
             "Smallest region, counted in subsampled points as the paper does");
    list.add("max_planes", options.max_planes, {1, 1000}, "Regions a frame; the paper's k");
    list.add("subsampling", options.subsampling, {1, 16},
             "Every n-th row and column is used; the paper's is 1, 2 or 4");
    list.add("max_iterations", options.max_iterations, at_least(1), "RANSAC trials a plane", kExpert);
    list.add("probability", options.probability, between(0, 1),
             "RANSAC stops early when a sample without outliers was drawn this probably", kExpert);
    return list;
}

OptionList options_of(SegmentationOptions& options) {
    OptionList list("Segmentation");
    list.add("method", options.method, {"cells", "ransac"},
             "'cells' fits planes to small cells and grows them; 'ransac' is the paper's (section 2.1)");
    list.add("seed", options.seed, kAnyNumber, "Of the random samples of 'ransac'", Audience::kExpert);
    list.append("cells.", options_of(options.cells));
    list.append("ransac.", options_of(options.ransac));
    return list;
}

void CellOptions::validate() const {
    check_options("cell options", *this);
}

void RansacOptions::validate() const {
    check_options("RANSAC options", *this);
}

void SegmentationOptions::validate() const {
    check_options("segmentation options", *this);
}

}  // namespace planemap::segmentation
