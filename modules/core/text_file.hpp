// SPDX-License-Identifier: BSD-3-Clause
// Text that people and other programs wrote.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace planemap {

/// The whole file as UTF-8 text, without a byte order mark. Throws as read_file(), and std::runtime_error for
/// UTF-16.
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes = std::size_t{1} << 32);

/// Text from outside for a message: control characters as ?, cut at `longest` bytes.
std::string shown_text(std::string_view text, std::size_t longest = 80);

}  // namespace planemap
