// SPDX-License-Identifier: BSD-3-Clause
// What is simulated, and its name: sim:WORLD?key=value&...
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/option_list.hpp"
#include "simulator/sensor_model.hpp"
#include "simulator/world.hpp"

namespace planemap::simulator {

/// What is simulated; options_of() says what each is.
struct SimulatorOptions {
    static constexpr int kMaxFrames = 1000000;

    std::string world = "office";  ///< see world_names()
    int frames = 0;
    std::uint64_t seed = 1;
    double rate_hz = 30;
    int width = 640, height = 480;
    bool noise = true;
    bool registered = true;
    double depth_units_per_metre = 1000;
    double depth_min_m = 0.5, depth_max_m = 4.0;
    double color_noise = 2.5;
    int blur_samples = 1;
    double shutter_s = 0.015;
    double color_jitter_s = 0;
    double exposure_drift = 0;
    double light = 1;
    double speed_m_s = 0.5;
    double turn_deg_s = 45;
    int visits = 0;
    std::string trajectory;
    double change_s = 10;
    std::string profile;  ///< see sensor_profiles(); its figures are in the fields, see use_profile()
    std::uint64_t specimen = 1;
    double sigma = 1;
    double bias = 0;
    double focal_error = 0;
    double mount_error_deg = 0;
    double distortion = 0;
    std::string lens;  ///< see parse_lens(); empty: what `distortion` says
    bool lens_told = true;
    bool mounted = false;
    double motion_noise = 0.02;
    double multipath = 0;
    bool edges = true, holes = true;

    /// What a profile says of size, range and errors. Throws std::invalid_argument for an unknown name.
    void use_profile(const std::string& name);
    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// By the keys of a name, "sim:WORLD?key=value&..."; all but the world. Refers to `options`, which must
/// outlive it.
OptionList options_of(SimulatorOptions& options);

/// The worlds there are.
std::vector<std::string> world_names();

/// For --help: the worlds, a line each, and the parameters that names take.
std::string simulator_help();

/// Reads "sim:WORLD?key=value&..."; what a profile says yields to what is said beside it. Throws
/// std::invalid_argument for an unknown world or key (listing what
/// there is), a value that is not a number, or one out of range.
SimulatorOptions parse_simulator_name(const std::string& name);

/// What camera.json says of the simulated sensor.
CameraInfo nominal_camera(const SimulatorOptions& options);

/// How the simulated sensor senses, beside its cameras and its bias.
DepthSensorOptions depth_options(const SimulatorOptions& options, const CameraInfo& camera);

/// The world of that name. Precondition: the options are valid.
World make_world(const SimulatorOptions& options);

}  // namespace planemap::simulator
