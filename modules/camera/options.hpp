// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/camera.hpp"
#include "core/option_list.hpp"

namespace planemap::camera {

/// What a camera is asked for; options_of() says what each is. What it does is looked up once it streams.
struct CameraOptions {
    std::string resolution = "640x480";
    int rate_hz = 30;
    std::string depth_unit = "1mm";
    std::string registration = "auto";
    bool frame_sync = false;
    int exposure = 0;
    bool mirror = false;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
    /// Of the resolution, pixels.
    int width() const;
    int height() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(CameraOptions& options);

/// How a camera is opened.
struct CameraRequest {
    CameraOptions options{};
    std::optional<CameraInfo> described{};  ///< a camera.json, instead of what the device says of itself
    bool repeat = false;                    ///< a recording begins again at its end
    std::filesystem::path record{};         ///< .oni file of what a camera sends; empty: none

    /// True if depth is to lie at colour's pixels.
    bool wants_registration() const;
};

}  // namespace planemap::camera
