// SPDX-License-Identifier: BSD-3-Clause
// The few ROS messages that are read from bags, out of their bytes (little-endian, lengths of 32 bits). What
// RealSense's SDK changed is read as it wrote it. All throw std::runtime_error (reason only) where bytes are
// missing, before any memory is taken for them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/pose.hpp"

namespace planemap::convert {

/// std_msgs/Header.
struct RosHeader {
    std::int64_t utime = 0;
    std::string frame_id;
};

/// sensor_msgs/Image; `data` points into the message.
struct RosImage {
    RosHeader header;
    std::uint32_t height = 0, width = 0, step = 0;
    std::string encoding;
    bool is_bigendian = false;
    std::span<const std::uint8_t> data;
    float depth_unit_m = 0;  ///< RealSense's SDK appends it where the header's frame_id is "1"; else 0
};
RosImage read_image(std::span<const std::uint8_t> bytes);

/// sensor_msgs/CompressedImage; `data` points into the message.
struct RosCompressedImage {
    RosHeader header;
    std::string format;
    std::span<const std::uint8_t> data;
};
RosCompressedImage read_compressed_image(std::span<const std::uint8_t> bytes);

/// sensor_msgs/CameraInfo, the part that is used.
struct RosCameraInfo {
    std::uint32_t height = 0, width = 0;
    std::string distortion_model;
    std::vector<double> D;
    std::array<double, 9> K{};
    std::array<double, 12> P{};
};
RosCameraInfo read_camera_info(std::span<const std::uint8_t> bytes);

/// geometry_msgs/Transform. Throws for a rotation that is none, too.
Pose read_transform(std::span<const std::uint8_t> bytes);

/// tf2_msgs/TFMessage.
struct RosTransform {
    std::string frame, child_frame;
    Pose frame_from_child = Pose::Identity();
};
std::vector<RosTransform> read_transforms(std::span<const std::uint8_t> bytes);

/// std_msgs/Float32.
float read_float(std::span<const std::uint8_t> bytes);
/// diagnostic_msgs/KeyValue.
std::pair<std::string, std::string> read_key_value(std::span<const std::uint8_t> bytes);

}  // namespace planemap::convert
