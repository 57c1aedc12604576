// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace planemap {

/// What is wrong with a log.
struct LogDamage {
    std::int64_t events = 0;         ///< that are whole
    std::int64_t undecodable = 0;    ///< of them: of a type that we know, and not to be decoded
    std::vector<std::string> lines;  ///< a line each, with the place; the first 20 of a kind
};

/// Reads a whole log: which bytes are no events, and which events are no messages of their type. `progress`
/// and errors as summarise() has them.
LogDamage find_damage(const std::filesystem::path& file, const std::function<bool(double)>& progress);

}  // namespace planemap
