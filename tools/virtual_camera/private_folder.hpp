// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace planemap::virtual_camera {

/// A temporary folder with a libOpenNI2 of its own that loads the virtual camera's driver and the one that
/// plays .oni files, and no other: found first by a program that has it in LD_LIBRARY_PATH. Removed at the
/// end.
class PrivateFolder {
  public:
    /// Throws std::runtime_error that names what is missing.
    explicit PrivateFolder(const std::filesystem::path& driver);
    ~PrivateFolder();
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace planemap::virtual_camera
