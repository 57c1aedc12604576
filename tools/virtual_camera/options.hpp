// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "core/option_list.hpp"

namespace planemap::virtual_camera {

/// What the device does, its faults above all; options_of() says what each is.
struct Options {
    double rate_hz = 30;
    std::string color = "yes";
    std::string registration = "works";
    double jitter_ms = 0;
    double drop = 0;
    double color_drop = 0;
    double color_offset_ms = 0;
    double clock_ppm = 0;
    double clock_reset_s = 0;
    double freeze_s = 0;
    double unplug_s = 0;
    double back_s = 0;
    bool once = false;
    std::uint64_t seed = 1;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(Options& options);

/// What the program hands to the driver, which OpenNI2 loads into another program.
struct Order {
    std::string input;  ///< as planemap-sensor takes it
    Options options;
};

/// The environment variable that carries an Order.
inline constexpr const char* kOrderVariable = "PLANEMAP_VIRTUAL_CAMERA";

/// "INPUT\nname=value\n...", which read_order() reads back. The latter throws std::invalid_argument for
/// anything else.
std::string to_text(Order order);
Order read_order(const std::string& text);

}  // namespace planemap::virtual_camera
