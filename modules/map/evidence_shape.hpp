// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/geometry/outline.hpp"
#include "map/edges.hpp"
#include "map/evidence_grid.hpp"

namespace planemap::map {

/// How a plane's shape is read off its evidence.
struct OutlineOptions {
    int min_support;     ///< that a cell needs to be part of the shape, 1 to 15
    double min_ring_m2;  ///< smaller parts and smaller holes are left out
    double tolerance_m;  ///< no traced vertex is further than this from the simplified outline, but for
    double least_m2;     ///< teeth and notches whose corners enclose less, see EdgeRules
};

/// The shape of what a plane's evidence says is there: cells with enough support; slits of up to two cells
/// closed, slivers of up to two cells left out unless they are well supported. Metres in the grid's x and y;
/// its rings do not cross.
/// It ends at the lines where other planes meet it, if it comes within their reach: see end_at().
Outline outline_of(const EvidenceGrid& grid, const OutlineOptions& options,
                   const std::vector<MeetingLine>& lines = {});

/// The same as exact as cells are and cheap, for what is compared and not shown: rings may cross.
Outline exact_outline_of(const EvidenceGrid& grid, const OutlineOptions& options);

}  // namespace planemap::map
