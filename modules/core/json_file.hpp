// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace planemap {

/// Reads a JSON file; one that a person wrote is no larger than the megabyte that is allowed if nothing is
/// said. Throws std::runtime_error if it cannot be read or is larger than max_bytes, and
/// std::invalid_argument that names the file for a syntax error (with line and column), a key that stands
/// twice in an object, more than 8 levels of nesting, or anything but an object.
nlohmann::json read_json_object(const std::filesystem::path& file,
                                std::size_t max_bytes = std::size_t{1} << 20);

}  // namespace planemap
