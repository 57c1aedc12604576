// SPDX-License-Identifier: BSD-3-Clause
// Where planes of the map meet (paper section 2.3).
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/plane_intersection.hpp"
#include "core/plane_map.hpp"

namespace planemap::map {

/// When two planes count as adjacent.
struct AdjacencyRules {
    double gap_m;          ///< each outline comes this near to the common line
    double min_angle_rad;  ///< flatter pairs have no well-defined line
    double min_length_m;   ///< shorter pieces of the line are left out
    double slack_m;        ///< by which outlines err, whatever their readings
};

/// How near to their common line two planes end that end at it: as near as outlines and the planes' readings
/// (RMS of both about their planes) tell, and the gap at most. Readings within their noise of both planes may
/// be of either. `sine` is of the angle between the planes.
double meeting_reach(double rms_a, double rms_b, double sine, const AdjacencyRules& rules);

/// A plane of the map unpacked for cutting it with others.
struct PlaneShape {
    int id = -1;
    Plane plane;
    double rms = 0;  ///< of the readings about it
    Box box;
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< of the box
    Outline outline;                                                                ///< in the box's x and y

    PlaneShape() = default;
    explicit PlaneShape(const MapPlane& map_plane);
};

/// The pieces of the common line of two planes that lie within the gap of both outlines, in order along the
/// line; empty for planes that are nearly parallel or not adjacent. An outline that is broken (a door in a
/// wall) breaks the line there too.
std::vector<IntersectionLine> intersection_lines(const PlaneShape& a, const PlaneShape& b,
                                                 const AdjacencyRules& rules);

/// The common point of three planes, if it is well-defined and within the gap of all three outlines.
std::optional<IntersectionPoint> intersection_point(const PlaneShape& a, const PlaneShape& b,
                                                    const PlaneShape& c, const AdjacencyRules& rules);

}  // namespace planemap::map
