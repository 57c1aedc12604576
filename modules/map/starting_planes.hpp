// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "core/plane_map.hpp"
#include "map/plane_estimate.hpp"

namespace planemap::map {

/// Planes of a finished map to go on from.
struct StartingPlanes {
    std::vector<PlaneEstimate> planes;
    std::size_t refused = 0;    ///< out of range
    std::size_t coarsened = 0;  ///< of the planes: those with cells larger than wanted
};

/// Planes that are larger than max_extent_m, or further out than kMaxCoordinate_m, are refused. Shapes have
/// cells of cell_m; those of a very large map coarser ones, the largest first, so that all take 128 MB.
StartingPlanes starting_planes(const PlaneMap& map, double max_extent_m, double cell_m);

}  // namespace planemap::map
