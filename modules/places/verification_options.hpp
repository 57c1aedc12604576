// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "places/matching.hpp"

namespace planemap::places {

/// When two views show the same.
struct VerificationOptions {
    MatchingOptions matching;
    double bearing_sigma = 0.003;  ///< of the points across their rays, radians
    int max_ransac_iterations = 300;
    int min_inliers = 25;             ///< matched points that agree with the pose
    double min_inlier_ratio = 0.35;   ///< of the matches
    double min_visible_ratio = 0.12;  ///< inliers, of the points of either view that the other should see
    int min_cells = 5;  ///< of a 4 by 4 grid over either view, how many the inliers must fall into
    double max_sigma_m = 0.05, max_sigma_rad = 0.03;  ///< of the pose in its worst direction
    double max_contradiction = 0.25;  ///< share of plane samples that the other view saw through
    bool must_be_unique = true;       ///< no other pose may explain the two views about as well
};

}  // namespace planemap::places
