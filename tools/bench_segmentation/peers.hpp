// SPDX-License-Identifier: BSD-3-Clause
// Other people's methods.
#pragma once

#include <cstdint>
#include <memory>

#include "benchmark/plane_finder.hpp"
#include "segmentation/ransac.hpp"

namespace planemap::bench {

/// PCL's organised multi-plane segmentation with refinement (Trevor et al. 2013) on 3D-gradient normals, with
/// PCL's defaults (3 deg, 2 cm) and `min_inliers` points at least; the point cloud and the normals are part
/// of the time.
std::unique_ptr<benchmark::Finder> make_organised(int min_inliers);

/// The project's ransac with PCL's templates from Debian's library instead of ones compiled with the
/// project's flags.
std::unique_ptr<segmentation::Segmenter> make_debian_ransac_segmenter(
    const segmentation::RansacOptions& options, std::uint64_t seed);

/// Keeps PCL from writing a line for every unlucky sample.
void silence_pcl();

}  // namespace planemap::bench
