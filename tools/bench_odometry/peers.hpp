// SPDX-License-Identifier: BSD-3-Clause
// Other people's odometry.
#pragma once

#include <functional>
#include <string>

#include "bench_odometry/run.hpp"

namespace planemap::bench_odometry {

/// OpenCV's dense odometry from frame to frame with its default options, on one thread: "opencv-rgbd" or
/// "opencv-rgbdicp". It gets what ours gets: luma, and depth registered to it within the sensor's range. Its
/// preparation of a frame (pyramids, normals) is in its time and used again for the next pair. A frame that
/// it cannot align is lost, and the next one is aligned to the last that was not. Throws as open_input().
MethodRun run_peer(const std::string& method, const std::string& input, std::int64_t max_frames,
                   const std::function<void(std::int64_t)>& on_frame);

}  // namespace planemap::bench_odometry
