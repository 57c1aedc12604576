// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "benchmark/plane_finder.hpp"

namespace planemap::benchmark {

/// OpenCV's RgbdPlane (Poppinga et al. 2008, as in ORK's tabletop) with the Kinect's error model; blocks of
/// `block_px` pixels. Without normals a block grows by distance to the plane alone; with them (FALS) by
/// the angle of each pixel's normal, too. The point cloud and the normals are part of the time.
std::unique_ptr<Finder> make_rgbd_plane(int block_px, bool with_normals);

/// The block for images of which every step-th pixel is taken: 40 pixels of the whole image, at least 4 of
/// its own.
int rgbd_plane_block_px(int step);

}  // namespace planemap::benchmark
