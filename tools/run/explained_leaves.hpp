// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/plane_map.hpp"

namespace planemap {

/// Those of the cells (centres, world frame, metres) that lie within `within_m` of a plane's outline, in
/// their order.
std::vector<Eigen::Vector3d> explained_leaves(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves,
                                              double within_m);

}  // namespace planemap
