// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/trajectory.hpp"

namespace planemap::bench_map {

/// Poses that err as a tracker's do: slowly, and by so much about each axis.
struct PoseNoise {
    double sigma_m = 0, sigma_deg = 0;  ///< RMS about each axis
};

/// The trajectory with smooth errors in the camera's frame: three sines an axis, of periods of 4 to 20 s,
/// the same for the same seed.
Trajectory with_noise(Trajectory trajectory, const PoseNoise& noise, unsigned seed);

}  // namespace planemap::bench_map
