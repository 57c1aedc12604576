// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace planemap {

/// Reads a JSON file that a person wrote. Throws std::runtime_error if it cannot be read, and
/// std::invalid_argument that names the file for a syntax error (with line and column), a key that stands
/// twice in an object, more than 8 levels of nesting, or anything but an object.
nlohmann::json read_json_object(const std::filesystem::path& file);

}  // namespace planemap
