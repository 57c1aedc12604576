// SPDX-License-Identifier: BSD-3-Clause
// Other people's methods.
#pragma once

#include <cstdint>
#include <memory>

#include "bench_segmentation/methods.hpp"
#include "segmentation/ransac.hpp"

namespace planemap::bench {

/// PCL's organised multi-plane segmentation with refinement (Trevor et al. 2013) on 3D-gradient normals, with
/// PCL's defaults (3 deg, 2 cm) and `min_inliers` points at least; the point cloud and the normals are part
/// of the time.
std::unique_ptr<Finder> make_organised(int min_inliers);

/// OpenCV's RgbdPlane (Poppinga et al. 2008, as in ORK's tabletop) with the Kinect's error model; blocks of
/// `block_px` pixels. Without normals a block grows by distance to the plane alone; with them (FALS) by
/// the angle of each pixel's normal, too. The point cloud and the normals are part of the time.
std::unique_ptr<Finder> make_rgbd_plane(int block_px, bool with_normals);

/// The project's ransac with PCL's templates from Debian's library instead of ones compiled with the
/// project's flags.
std::unique_ptr<segmentation::Segmenter> make_debian_ransac_segmenter(
    const segmentation::RansacOptions& options, std::uint64_t seed);

/// Keeps PCL from writing a line for every unlucky sample.
void silence_pcl();

}  // namespace planemap::bench
