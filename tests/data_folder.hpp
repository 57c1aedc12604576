// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace planemap::test {

/// A sequence of the sample data: in $PLANEMAP_DATA, else in ../shared/data beside the project.
inline std::filesystem::path data_folder(const std::string& sequence) {
    const char* root = std::getenv("PLANEMAP_DATA");
    const std::filesystem::path base =
        root != nullptr ? std::filesystem::path(root)
                        : std::filesystem::path(PLANEMAP_SOURCE) / ".." / "shared" / "data";
    return base / sequence;
}

}  // namespace planemap::test

/// Skips the test, saying so, when a sequence of the sample data is missing.
#define PLANEMAP_NEEDS_DATA(sequence)                                            \
    if (!std::filesystem::is_directory(planemap::test::data_folder(sequence))) { \
        GTEST_SKIP() << "sample data " << planemap::test::data_folder(sequence)  \
                     << " is missing (set PLANEMAP_DATA)";                       \
    }
