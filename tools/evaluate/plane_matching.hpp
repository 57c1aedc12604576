// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/plane_map.hpp"

namespace planemap::evaluation {

/// A plane of one map and the plane of another that says the same surface.
struct PlaneMatch {
    int a = -1, b = -1;   ///< ids
    double offset_m = 0;  ///< from a to b along a's normal, in the middle of where both are
    double angle = 0;     ///< between the normals, radians

    /// Within what two maps of one scene differ by: 3 cm and 2 deg.
    bool is_in_place() const;
};

struct PlaneMatches {
    std::vector<PlaneMatch> pairs;  ///< by a; each plane at most once
    std::vector<int> only_a, only_b;
    /// For each of only_b the plane of a that it lies on in place, which another one matches: the plane was
    /// split; -1 for none.
    std::vector<int> on_a;
};

/// Matches planes by geometry alone, both maps in one world frame: they face the same way within 20 deg, lie
/// at most 50 cm apart, and cover each other's boxes by at least 30 % of the smaller one; the closest first.
/// Planes that are not finite or have no outline match nothing.
PlaneMatches match_planes(const PlaneMap& a, const PlaneMap& b);

}  // namespace planemap::evaluation
