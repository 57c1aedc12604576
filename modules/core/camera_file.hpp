// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.hpp"

namespace planemap {

/// Reads a camera.json:
///   {"depth_camera": {"width": 640, "height": 480, "fx": 585, "fy": 585, "cx": 320, "cy": 240,
///                     "distortion": {"model": "brown", "coefficients": [k1, k2, p1, p2]}},   distortion is
///                                          optional, see LensDistortion
///    "depth_units_per_metre": 1000,
///    "registered": false,                  optional: true if there is no color_from_depth
///    "color_camera": {...},                like depth_camera, which it defaults to if registered
///    "color_from_depth": {"rotation_vector_rad": [0, 0, 0], "translation_m": [-0.025, 0, 0]},
///    "sensor": "kinect1",                  optional: range and noise of that preset, see sensor_presets()
///    "depth_range_m": [0.3, 8],            optional, instead of the preset's
///    "noise": {"base_m": 0.0012, "quadratic_per_m": 0.0019, "offset_m": 0.4},   optional, as each of its
///                                          keys, instead of the preset's
///    "depth_correction": {"offsets_per_m": [20 numbers], "sigmas_per_m": [20 numbers]},   optional, see
///                                          DepthCorrection; planemap-calibrate writes it
///    "camera_from_accelerometer": {"rotation_vector_rad": [...]},  optional, see camera_from_accelerometer()
///    "body_from_camera": {"rotation_vector_rad": [...], "translation_m": [...]},  optional: how the colour
///                                          camera is mounted on the robot (x forward, y left, z up)
///    "serial": "K1", "note": "...", "poses_of": "color_camera"}                 optional
/// A note says what stands there in vain. Throws std::runtime_error if the file cannot be read, and
/// std::invalid_argument that names the file and every bad field at once: value and what is allowed; unknown
/// keys with the nearest known one; syntax errors with line and column.
CameraInfo read_camera_file(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr);

/// The text of a camera.json that read_camera_file() reads as the same camera, but for roundings of the
/// rotation's last digits.
std::string camera_file_text(const CameraInfo& camera);

/// The text of that camera.json with the correction in it, and all else as it stands there. Throws as
/// read_json_object().
std::string with_depth_correction(const std::filesystem::path& file, const DepthCorrection& correction);

/// The published intrinsics of the TUM RGB-D benchmark's sensors (registered, 5000 units a metre) if the name
/// of the folder holds "freiburg1", "freiburg2" or "freiburg3"; else nothing.
std::optional<CameraInfo> tum_camera(std::string_view folder_name);

/// How an accelerometer lies in the camera frame: "camera_from_accelerometer" of a camera.json, a rotation
/// (rotation_vector_rad); without it, or without the file, as a Kinect v1's does: its x left, y up, z ahead.
/// Throws as read_camera_file(), of this key alone.
Eigen::Matrix3d camera_from_accelerometer(const std::filesystem::path& camera_file);

/// The camera of a dataset folder: its camera.json, or what tum_camera() knows. Throws as read_camera_file(),
/// and std::runtime_error that shows what to write if there is neither.
CameraInfo camera_of_folder(const std::filesystem::path& folder, std::vector<std::string>* notes = nullptr);

}  // namespace planemap
