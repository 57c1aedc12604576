// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "core/option_list.hpp"
#include "segmentation/cell_kernels.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

/// The default method: planes are fitted to inverse depth in cells of 8 x 8 pixels, grown over cells,
/// brought to pixel-sharp borders, and fitted again. Lengths that stand beside a number of sigmas are lower
/// bounds: the tolerance at depth z is the larger of the length and that many times camera.noise.sigma(z).
/// options_of() says what each option is.
struct CellOptions {
    double min_region_fraction = 0.0064;
    double grow_m = 0.01;
    double grow_sigmas = 1.5;
    double merge_m = 0.013;
    double merge_sigmas = 1.9;
    double merge_angle_deg = 30;
    double bend_deg = 35;
    double thickness_m = 0.015;
    double thickness_sigmas = 3;

    // Fixed: nobody can tell how to set these without reading the code.
    static constexpr double min_fill = 0.6;  ///< share of a cell's pixels that must be valid for a fit
    static constexpr double planarity_sigmas = 1.2;  ///< largest RMS of a planar cell
    static constexpr double lateral_px = 0.5;  ///< standard deviation of where a reading was taken, pixels
    static constexpr double step_m = 0.006;    ///< largest step between neighbouring cells of one plane
    static constexpr double step_sigmas = 1.5;
    static constexpr double grow_angle_deg = 15;  ///< largest angle between cell and region, beyond the
                                                  ///< cell's own error

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(CellOptions& options);

/// The cell-based segmenter. moments are those of the labelled pixels; plane is the fit to them weighted by
/// the sensor's noise. Throws std::invalid_argument for bad options.
std::unique_ptr<Segmenter> make_cell_segmenter(const CellOptions& options,
                                               const CellKernels& kernels = best_cell_kernels());

}  // namespace planemap::segmentation
