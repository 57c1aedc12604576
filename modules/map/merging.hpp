// SPDX-License-Identifier: BSD-3-Clause
// When two planar regions are the same plane of the world: the rules of paper section 2.3. Others ask what
// looks alike and is not: segmentation/merging whether two parts of one image fit a common plane within the
// noise, odometry which region of the keyframe a point lies on, graph/landmarks and places/verification what
// may hold two poses together, map/hand_over which of regions known to be one plane covers another.
#pragma once

#include <optional>

#include "core/geometry/box.hpp"

namespace planemap::map {

/// Thresholds of paper section 2.3, whose own values are in core/geometry/same_plane.hpp.
struct MergeRules {
    double angle_rad;   ///< between the normals; opposite sides of a wall differ by pi
    double distance_m;  ///< between the planes, where the regions are
    double gap_m;       ///< between the boxes, within the plane
};

/// How one plane lies to another.
struct RegionRelation {
    double angle_rad = 0;   ///< between the normals, in [0, pi]
    double distance_m = 0;  ///< RMS distance between the planes over the overlap of the boxes; of boxes that
                            ///< do not overlap, midway between their nearest points
    double gap_m = 0;       ///< between the boxes within the plane, 0 when they overlap

    /// How far the rules are used up, 0 to 3: the smaller, the better two regions fit.
    double score(const MergeRules& rules) const;
};

/// Compares two regions by planes and boxes. It is symmetric, and it measures where both regions are:
/// at the origin, two metres of lever arm would turn 2 deg into 7 cm. Both planes are looked at along their
/// mean normal, so it says something for angles well below a right angle only.
RegionRelation relate(const Plane& plane_a, const Box& box_a, const Plane& plane_b, const Box& box_b);

/// The relation when all three rules hold, nothing otherwise.
std::optional<RegionRelation> same_plane(const Plane& plane_a, const Box& box_a, const Plane& plane_b,
                                         const Box& box_b, const MergeRules& rules);

}  // namespace planemap::map
