// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/camera.hpp"

namespace planemap {

/// What is published about a kind of depth sensor.
struct SensorPreset {
    std::string name;        ///< as camera.json names it
    std::string title;       ///< what people call it
    double depth_min_m = 0;  ///< range in which its readings are to be trusted
    double depth_max_m = 0;  ///< its far end
    DepthNoise noise;        ///< of one reading, along the optical axis, of a surface seen from the front
    std::string source;      ///< of these figures: paper, data sheet or manual
};

/// All presets: the one table of them; docs/sensors.md shows it.
const std::vector<SensorPreset>& sensor_presets();

/// The preset of that very name, or nullptr.
const SensorPreset* find_sensor_preset(std::string_view name);

/// The names, in the table's order.
std::vector<std::string> sensor_preset_names();

}  // namespace planemap
