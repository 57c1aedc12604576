// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/frame_source.hpp"
#include "core/trajectory.hpp"
#include "sensor/sensor_shell.hpp"

namespace planemap::convert {

struct ConvertOptions {
    std::string channel;                   ///< of a log's frames; empty: the first with depth
    std::string depth_topic, color_topic;  ///< of a bag; empty: chosen
    std::optional<CameraInfo> camera;      ///< instead of what the input says
    double max_color_gap_s = 0.02;         ///< between the stamps of depth and its colour
    double rate_hz = 30;                   ///< of images that are only numbered
    double depth_units_per_metre = 1000;   ///< of a camera's folder that does not say
    std::string to = "auto";               ///< "log", "tum", "fakenect", or "auto": by the name of the output
    sensor::SensorShellOptions encoding;   ///< of what goes to a log
    bool quiet = false;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Channel of the true poses of the colour camera (bot_core.pose_t, world_from_camera) in a log.
inline constexpr const char* kTruthChannel = "GROUNDTRUTH";

/// Opens a ROS 1 bag, a camera's folder, or anything that sensor::open_source() does. Throws
/// std::runtime_error and std::invalid_argument, one line that names input, reason and way out; ROS 2 bags
/// and .mkv recordings are refused by their names.
std::unique_ptr<FrameSource> open_input(const std::string& input, const ConvertOptions& options);

/// The true trajectory that comes with an input: groundtruth.txt in a folder or beside a log, GROUNDTRUTH in
/// a log, the simulator's. Empty where there is none.
Trajectory truth_of(const std::string& input, const FrameSource& source);

/// Writes the input to `output`, a log, a folder in the TUM layout, or one that fakenect
/// plays in place of a Kinect v1, which must not be there yet, and prints
/// what came over and what did not. Throws std::runtime_error naming file and reason; the output is then not
/// there.
void convert(const std::string& input, const std::filesystem::path& output, const ConvertOptions& options);

}  // namespace planemap::convert
