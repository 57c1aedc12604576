// SPDX-License-Identifier: BSD-3-Clause
// Table 1 of the paper: what subsampling does to the plane in front of the sensor.
#pragma once

#include <string>
#include <vector>

#include "bench_segmentation/methods.hpp"
#include "bench_segmentation/sequences.hpp"
#include "benchmark/report.hpp"

namespace planemap::bench {

using results::Json;

/// One row: a method at one distance, the median over all frames (false planes: the mean).
struct Table1Row {
    double distance_m = 0;  ///< true one, of the sensor to the wall
    MethodName method;
    double seconds = 0;               ///< thread's CPU time
    double inliers = 0;               ///< N of the wall's region as the method counts it: subsampled points
    double estimated_distance_m = 0;  ///< of the sensor to the wall's region; NaN: the wall was not found
    double false_planes = 0;          ///< a frame: regions on no true plane, or the second and further on one
};

/// A wall in front of the sensor, with a box before it on the right and the floor below, as a Kinect sees it
/// `distance_m` away: one frame a seed, each turned a little further (up to 6 deg).
BenchFrame wall_scene(double distance_m, std::uint64_t seed, const CameraInfo& camera);

/// Measures one row. `frames` and `camera` are wall_scene()'s.
Table1Row measure_table1(const MethodName& name, double distance_m, const std::vector<BenchFrame>& frames,
                         const CameraInfo& camera);

/// Reports the paper's own rows, and ours, method by method.
void print_table1(const std::vector<MethodName>& methods, benchmark::Report& report);

}  // namespace planemap::bench
