// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/validation.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

/// The paper's method (section 2.1): the plane with the most inliers is found by RANSAC and removed, again
/// and again.
struct RansacOptions {
    double thickness_m = 0.015;  ///< largest distance of an inlier to its plane, metres
    int min_inliers = 700;       ///< smallest region, counted in subsampled points as the paper does
    int max_planes = 3;          ///< regions per frame; the paper's k
    int subsampling = 4;         ///< every n-th row and column is used: 1 to 16 (the paper: 1, 2, 4)
    int max_iterations = 1000;   ///< RANSAC trials per plane
    double probability = 0.99;   ///< stop early when a sample without outliers was drawn this probably

    /// Adds the bad fields to `errors`, their names led by `prefix`.
    void check(const std::string& prefix, FieldErrors& errors) const;
};

/// The segmenter with PCL's RANSAC. A region's points, and so its N, moments and RMS, are the subsampled
/// inliers; `labels` covers all pixels: one carries its sample's label if it lies within the thickness too.
/// The same seed gives the same regions. Throws std::invalid_argument for bad options.
std::unique_ptr<Segmenter> make_ransac_segmenter(const RansacOptions& options, std::uint64_t seed);

}  // namespace planemap::segmentation
