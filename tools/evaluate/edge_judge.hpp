// SPDX-License-Identifier: BSD-3-Clause
// Where planes meet: a map's lines and points beside the true ones, and its outlines beside its own lines.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "evaluate/plane_judge.hpp"

namespace planemap::evaluation {

struct EdgeLimits {
    double near_m = 0.05;        ///< of a line or a point to the true one that it is
    double seen_m = 0.05;        ///< of an edge to the visible surface of both planes, for it to be seen
    double corner_seen_m = 0.1;  ///< the same for a corner and its three planes
    double there_m = 0.3;        ///< the same for a line or a point of the map to be on a true one at all
    double least_m = 0.25;       ///< shorter pieces of edges are left out
    double max_angle_deg = 10;   ///< between a line and the true edge that it is
};

/// Edges and corners of a map beside those of the truth.
struct EdgeJudgement {
    double true_m = 0, found_m = 0;    ///< edges that were seen; of those, what a line of the map is near
    double lines_m = 0, right_m = 0;   ///< the map's lines; of those, what is near an edge, seen or not
    std::size_t corners = 0, met = 0;  ///< that were seen; of those, near a point of the map
    std::size_t points = 0, right_points = 0;  ///< the map's points; of those, near a corner, seen or not

    /// Shares; nothing where there is nothing to have a share of.
    std::optional<double> edges_found() const;
    std::optional<double> lines_right() const;
    std::optional<double> corners_found() const;
    std::optional<double> points_right() const;
};

/// Compares a map's lines and points with the places where true planes meet. `truth_from_map` lays the map's
/// world on the truth's. An edge is where two true planes of more than kLeastArea_m2 meet and both were seen
/// up to it; whether a line of the map is right is asked of all true planes.
EdgeJudgement judge_edges(const std::vector<TruePlane>& truth, const PlaneMap& map,
                          const Pose& truth_from_map, const EdgeLimits& limits = {});

/// How far outlines end from the lines where planes meet: for each line of the map, each of its two planes,
/// each 2 cm, from the line to the nearest edge of the outline square to it. Where an outline goes through
/// the line, or is not there, by more than 15 cm, nothing is measured. Metres, in no order.
std::vector<double> outline_gaps(const PlaneMap& map);

}  // namespace planemap::evaluation
