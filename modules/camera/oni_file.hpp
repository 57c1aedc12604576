// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace planemap::camera {

/// Walks the records of an OpenNI recording from its header to its end record. Throws std::runtime_error, one
/// line that names the file and the place, for a file that is none, is cut short, or was not closed:
/// OpenNI2's player waits for ever or fails without a reason there.
void check_oni_file(const std::filesystem::path& file);

}  // namespace planemap::camera
