// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/frame_source.hpp"
#include "core/trajectory.hpp"

namespace planemap::convert {

/// What write_tum_folder() did.
struct TumFolder {
    std::int64_t frames = 0, broken = 0, colorless = 0;  ///< written; not; written without their colour
    std::int64_t repeated = 0;                           ///< left out: their stamp was there already
};

/// Writes a source's frames as a folder in the layout of the TUM RGB-D benchmark, as planemap reads it:
/// depth/ and rgb/ with images named by their stamps (a stored JPEG as it is, pixels as PNG), depth.txt,
/// rgb.txt, associations.txt where there is colour, accelerometer.txt where there was one, and camera.json;
/// groundtruth.txt where `truth` holds poses. Depth, stamps and pairs come back as they were. `folder` must
/// not be there; it is whole or not there at all. Calls `go_on` with the frames so far, and throws
/// std::runtime_error when it gives false. `say` is told of what could not be read, a line the first time of
/// each reason.
TumFolder write_tum_folder(FrameSource& source, const Trajectory& truth, const std::filesystem::path& folder,
                           const std::function<bool(std::int64_t)>& go_on,
                           const std::function<void(const std::string&)>& say);

}  // namespace planemap::convert
