// SPDX-License-Identifier: BSD-3-Clause
// What kinds of depth sensors do, beyond noise: the one table of it. docs/sensors.md has the sources.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.hpp"

namespace planemap::simulator {

/// How a sensor measures depth, and so what it does at edges, in corners and on blank walls.
enum class Principle { kStructuredLight, kTimeOfFlight, kStereo, kLidar };

/// A kind of sensor. Range and noise are those of the preset of the same name (core/sensor_preset).
struct SensorProfile {
    std::string name;
    Principle principle = Principle::kStructuredLight;
    PinholeCamera depth, color;  ///< as its camera.json says
    bool registered = true;      ///< its depth comes in the colour camera's image
    Pose color_from_depth = Pose::Identity();
    double baseline_m =
        0.075;        ///< to the projector or the other imager, along the depth camera's x; triangulation
    double bias = 0;  ///< relative error of depth at 4 m, root mean square over image and specimens
    double focal_error = 0;      ///< share by which true focal lengths miss the nominal ones
    double mount_error_deg = 0;  ///< rotation by which the depth camera misses its nominal mount
    double distortion = 0;       ///< of the lens, see Lens
    double multipath = 0;        ///< light that comes over a second surface, as a share of what physics says
};

/// All profiles.
const std::vector<SensorProfile>& sensor_profiles();

/// The profile of that very name, or nullptr.
const SensorProfile* find_sensor_profile(const std::string& name);

/// The cameras of one specimen as they are, beside what camera.json says of them.
struct TrueCameras {
    PinholeCamera depth, color;
    Pose color_from_depth = Pose::Identity();
};

/// A specimen's cameras: focal lengths are longer or shorter by the share `focal_error`, and the depth camera
/// is rotated by `mount_error_deg` and moved by 5 mm a degree; `specimen` decides which way.
TrueCameras true_cameras(const CameraInfo& nominal, double focal_error, double mount_error_deg,
                         std::uint64_t specimen);

}  // namespace planemap::simulator
