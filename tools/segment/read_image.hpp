// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>

#include "core/camera.hpp"
#include "core/files.hpp"
#include "sensor/png.hpp"

namespace planemap {

/// An image file of the depth camera's size; end_missing is set if it is cut short behind its last pixel.
/// Throws std::runtime_error that names the file.
template <typename Decode>
auto read_image(const std::filesystem::path& file, const CameraInfo& camera, const Decode& decode,
                bool* end_missing = nullptr) {
    const std::string bytes = read_file(file);
    try {
        return decode(bytes, camera.depth.width, camera.depth.height, end_missing);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(file.string() + ": " + error.what());
    }
}

}  // namespace planemap
