// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/frame_source.hpp"

namespace planemap::convert {

struct LayoutOptions {
    std::optional<CameraInfo> camera;     ///< instead of what the folder's files say
    double max_color_gap_s = 0.02;        ///< of images that are named by their stamps
    double rate_hz = 30;                  ///< of images that are only numbered
    double depth_units_per_metre = 1000;  ///< where no file of the folder says
};

/// True for a folder as the tools of RealSense and Azure Kinect cameras leave them: depth images in depth/
/// with colour in color/, rgb/ or image/, or both in the folder itself as NAME_Depth_STAMP.png and
/// NAME_Color_STAMP.png; and no lists as the TUM layout has them.
bool is_camera_layout(const std::filesystem::path& folder);

/// Reads such a folder. Images are paired by their stamps, or by their numbers. The camera is that of
///   camera.json: as everywhere;
///   intrinsic.json or camera_intrinsic.json (Open3D's recorders): depth is aligned to colour;
///   depth_intrinsic.json, color_intrinsic.json, and extrinsic.json or depth_to_color.json: depth as sensed.
/// Each intrinsic file holds width and height, and intrinsic_matrix (9 numbers, column by column) or fx, fy
/// and cx, cy (or ppx, ppy). The extrinsic file holds rotation (9 numbers column by column, as RealSense's
/// SDK has it, or three rows) and translation (metres; beyond 1 in size millimetres, as Azure Kinect's SDK
/// has it), or matrix (four rows). What is assumed is among the notes. Throws std::runtime_error and
/// std::invalid_argument, one line that names file and reason.
std::unique_ptr<FrameSource> open_layout(const std::filesystem::path& folder, const LayoutOptions& options);

}  // namespace planemap::convert
