// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/trajectory.hpp"
#include "evaluate/surface_check.hpp"

namespace planemap::bench_map {

/// Reads every fifth of (at most) `frames` frames of a recording again, for evaluation::SurfaceChecker at the
/// true poses.
std::vector<evaluation::SurfaceCheck> check_surfaces(const std::string& input, std::int64_t frames,
                                                     const std::optional<CameraInfo>& camera,
                                                     const PlaneMap& map, const Trajectory& truth);

}  // namespace planemap::bench_map
