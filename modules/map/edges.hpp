// SPDX-License-Identifier: BSD-3-Clause
// Edges of outlines: where planes meet they end at the common line, and straight ones have two vertices.
#pragma once

#include <vector>

#include "core/geometry/bitmap.hpp"
#include "core/geometry/outline.hpp"

namespace planemap::map {

/// A piece of a line at which another plane meets this one, metres in the x and y of the plane's raster.
struct MeetingLine {
    Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
    double reach_m = 0;  ///< the evidence's noise: a shape that ends within it of the line ends at the line
};

/// Continues a shape (cells of `cell_m`) up to the line where it ends before it within the reach, and cuts
/// off what stands out past it by no more. Where the shape goes on beyond the reach on both sides it goes
/// through, and stays as it is; so does what stands out where most cells around are certain (of the same
/// bitmap as the shape): that was seen well. What lies beside the bitmap is left out.
void end_at(const MeetingLine& line, double cell_m, const Bitmap& certain, Bitmap& shape);

/// How an outline is made of straight edges.
struct EdgeRules {
    double cell_m = 0.025;      ///< of the raster that was traced
    double tolerance_m = 0.03;  ///< by which an edge leaves traced vertices at most, but for
    double least_m2 = 0;        ///< corners that enclose less with their neighbours: teeth and notches
};

/// The outline of a shape, traced along its cells (metres), with straight edges: what lies within a cell and
/// a half of a meeting line is on it, and turns where two of them cross; other edges are fitted to the cells
/// along them. The rings of the result do not cross.
Outline with_straight_edges(const Outline& traced, const std::vector<MeetingLine>& lines,
                            const EdgeRules& rules);

}  // namespace planemap::map
