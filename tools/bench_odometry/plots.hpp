// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench_odometry/row.hpp"

namespace planemap::bench_odometry {

/// The direction that is up in a trajectory's world: the axis (of six) nearest to the mean of the cameras'
/// own up, or that mean itself where no axis is within 35 deg.
Eigen::Vector3d up_direction(const Trajectory& trajectory);

/// The rows' trajectories over the truth (of the time that they span) from above, as an SVG: each aligned to
/// the truth as for its ATE, with a legend that gives the ATE, and a scale bar. A line breaks where a second
/// and a half have no pose. Rows without an ATE are left out.
std::string plot_svg(const std::string& title, const Trajectory& truth, const std::vector<Row>& rows);

}  // namespace planemap::bench_odometry
