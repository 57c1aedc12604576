// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace planemap {

struct OctomapOptions {
    double resolution_m = 0.05;  ///< edge of a leaf
    double max_range_m = 0;      ///< readings further away clear space up to here and occupy nothing; 0: the
                                 ///< camera's depth_max_m
    int subsample = 1;           ///< every n-th pixel along u and v
    std::size_t max_keyframes = 2000;  ///< keyframes whose depth is kept for rebuilding (about 150 KB each).
                                       ///< Beyond it the oldest is frozen at its pose and its depth dropped
    double moved_m = 0.002;            ///< keyframes that moved less than this,
    double moved_deg = 0.05;           ///< and turned less than this, do not cause a rebuild

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

}  // namespace planemap
