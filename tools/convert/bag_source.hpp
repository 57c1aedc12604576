// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/frame_source.hpp"

namespace planemap::convert {

struct BagOptions {
    std::string depth_topic, color_topic;  ///< empty: chosen by the messages' types and encodings
    std::optional<CameraInfo> camera;      ///< instead of what the bag says
    double max_color_gap_s = 0.02;         ///< depth without a colour image this near in time has no colour
};

/// The depth and colour of a ROS 1 bag: sensor_msgs/Image and CompressedImage with their CameraInfo and tf,
/// or the topics that RealSense's SDK writes (/device_0/sensor_*/Depth_0/...: depth units and the cameras'
/// positions are messages there). Images are paired by their headers' stamps; colour without depth is
/// counted. Throws std::runtime_error, one line that names the file and the way out.
std::unique_ptr<FrameSource> open_bag(const std::filesystem::path& file, const BagOptions& options);

}  // namespace planemap::convert
