// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/data_folder.hpp"

#include <cstdlib>

namespace planemap {

std::filesystem::path default_data_folder() {
    if (const char* root = std::getenv("PLANEMAP_DATA")) return root;
    return std::filesystem::path(PLANEMAP_SOURCE) / ".." / "shared" / "data";
}

}  // namespace planemap
