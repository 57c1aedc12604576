// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace planemap {

/// The whole file as bytes. Throws std::runtime_error naming file and reason; also for a file over max_bytes.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes = std::size_t{1} << 32);

/// Writes beside the target and renames, so a reader or a kill never leaves half a file. A device or pipe is
/// written to as it is.
/// Throws std::system_error, a std::runtime_error, naming file and reason.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace planemap
