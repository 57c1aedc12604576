// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/option_list.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

/// The paper's method (section 2.1): the plane with the most inliers is found by RANSAC and removed, again
/// and again. options_of() says what each option is.
struct RansacOptions {
    double thickness_m = 0.015;
    int min_inliers = 700;
    int max_planes = 3;
    int subsampling = 4;
    int max_iterations = 1000;
    double probability = 0.99;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(RansacOptions& options);

/// The segmenter with PCL's RANSAC. A region's points, and so its N, moments and RMS, are the subsampled
/// inliers; `labels` covers all pixels: one carries its sample's label if it lies within the thickness too.
/// The same seed gives the same regions. Throws std::invalid_argument for bad options, and for any where
/// planemap was built without PCL (PLANEMAP_PCL=OFF).
std::unique_ptr<Segmenter> make_ransac_segmenter(const RansacOptions& options, std::uint64_t seed);

}  // namespace planemap::segmentation
