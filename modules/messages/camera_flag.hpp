// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "core/camera.hpp"
#include "messages/flags.hpp"

namespace planemap::messages {

/// --camera FILE, of all programs that may meet frames whose camera nobody describes.
class CameraFlag {
  public:
    /// Refers to this object, which must outlive the flags. `what_for` begins "camera.json ".
    void add_to(Flags& flags, const char* what_for);
    /// The camera, if the flag was given; what its file says in vain is warned of. Throws as
    /// read_camera_file().
    std::optional<CameraInfo> read() const;
    /// Empty if the flag was not given.
    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path file_;
};

/// What --camera is for where frames come off the bus.
inline constexpr const char* kCameraOffTheBus =
    "camera.json of frames whose camera nobody describes; a PLANEMAP_CAMERA_INFO that comes goes before it";

}  // namespace planemap::messages
