// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "core/validation.hpp"
#include "segmentation/cell_kernels.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

/// The default method: planes are fitted to inverse depth in cells of 8 x 8 pixels, grown over cells,
/// brought to pixel-sharp borders, and fitted again. Lengths that stand beside a number of sigmas are lower
/// bounds: the tolerance at depth z is the larger of the length and that many times camera.noise.sigma(z).
struct CellOptions {
    double min_region_fraction = 0.0064;  ///< smallest region as a share of the image's pixels
    double min_fill = 0.6;                ///< share of a cell's pixels that must be valid for a fit
    double planarity_sigmas = 1.2;        ///< largest RMS of a planar cell
    double lateral_px = 0.5;              ///< standard deviation of where a reading was taken, pixels
    double step_m = 0.006;                ///< largest step between neighbouring cells of one plane, metres
    double step_sigmas = 1.5;             ///< see above
    double grow_m = 0.01;                 ///< largest mean distance of a cell to its region's plane, metres
    double grow_sigmas = 1.5;             ///< see above
    double grow_angle_deg = 15;   ///< largest angle between cell and region, beyond the cell's own error
    double merge_m = 0.013;       ///< by how much two regions may leave their common plane (RMS), metres
    double merge_sigmas = 1.9;    ///< see above
    double merge_angle_deg = 30;  ///< largest angle between two regions to be merged
    double bend_deg = 35;         ///< a region that turns by more from end to end is curved: no plane
    double thickness_m = 0.015;   ///< largest distance of a pixel to its region's plane, metres
    double thickness_sigmas = 3;  ///< see above

    /// Adds the bad fields to `errors`, their names led by `prefix`.
    void check(const std::string& prefix, FieldErrors& errors) const;
};

/// The cell-based segmenter. moments are those of the labelled pixels; plane is the fit to them weighted by
/// the sensor's noise. Throws std::invalid_argument for bad options.
std::unique_ptr<Segmenter> make_cell_segmenter(const CellOptions& options,
                                               const CellKernels& kernels = best_cell_kernels());

}  // namespace planemap::segmentation
