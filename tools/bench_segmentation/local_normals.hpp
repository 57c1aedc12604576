// SPDX-License-Identifier: BSD-3-Clause
// What a depth image itself says about surfaces, pixel by pixel, to judge planes by where there is no truth.
#pragma once

#include "evaluate/readings.hpp"

namespace planemap::bench {

using evaluation::for_each_reading;
using evaluation::is_trusted;

/// The unit normal of the surface around each pixel in the depth camera's frame, towards the sensor; zero
/// where the surface is not locally planar. It is the least-squares plane in inverse depth of the trusted
/// readings in the 17 x 17 pixels around. A pixel is locally planar when its own reading is trusted, at
/// least half of the window's 289 are (none lies beyond the image), and their RMS distance to the plane along
/// the optical axis is at most 2 sigma(z) at their mean inverse depth, sigma being that of a Kinect
/// (DepthNoise's default) whatever the sensor. Sums slide over the image, so the time does not depend on the
/// window.
Image<Eigen::Vector3f> local_normals(const DepthImage& depth, const CameraInfo& camera);

}  // namespace planemap::bench
