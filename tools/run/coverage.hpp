// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/plane_map.hpp"

namespace planemap {

/// How much of what is there the planes say: without it, a map's size means nothing.
struct Coverage {
    double leaves_explained = 0;  ///< share of the occupied leaves whose centre lies within one leaf size of
                                  ///< a plane's outline; 0 without leaves
    double area_supported = 0;    ///< share of the outlines' area within one leaf size of the centre of an
                                  ///< occupied leaf; 0 without area
    double leaves_explained_half = 0;  ///< as leaves_explained, within half a leaf size
};

/// Compares a plane map with the occupied leaves of an OctoMap: their centres (world frame, metres) and the
/// edge of a leaf (metres). Leaves larger than that must be given as the small ones they consist of. The
/// area is sampled at half a leaf size.
Coverage coverage_of(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves, double leaf_m);

/// The leaves of Coverage::leaves_explained, in their order.
std::vector<Eigen::Vector3d> explained_leaves(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves,
                                              double leaf_m);

}  // namespace planemap
