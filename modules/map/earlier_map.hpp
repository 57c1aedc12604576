// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace planemap::map {

/// What keep_earlier_map() did.
struct KeptMap {
    std::filesystem::path file;                  ///< the earlier map's other name
    std::vector<std::filesystem::path> removed;  ///< older ones
};

/// Gives a map that is about to be replaced a second name beside its own, NAME.earlier-DATE-N.lcmlog (DATE:
/// when it was last written, UTC), so that it is there at any moment. The newest five of these are kept.
/// Throws std::runtime_error naming the file if it cannot be kept.
KeptMap keep_earlier_map(const std::filesystem::path& file);

}  // namespace planemap::map
