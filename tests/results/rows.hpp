// SPDX-License-Identifier: BSD-3-Clause
// What the tests of rows share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "results/table.hpp"

namespace planemap::results {

/// Each row's line is as long as the heading, and has its bars where that has them.
inline void expect_aligned(const Table& table, const std::vector<Json>& rows) {
    const std::string heading = table.heading();
    for (const Json& row : rows) {
        const std::string line = table.line(row);
        EXPECT_EQ(line.size(), heading.size()) << line;
        for (std::size_t i = 0; i < std::min(line.size(), heading.size()); ++i)
            EXPECT_EQ(line[i] == '|', heading[i] == '|') << line;
    }
}

/// The keys are there, and null.
inline void expect_null(const Json& row, std::initializer_list<const char*> keys) {
    for (const char* key : keys) {
        ASSERT_TRUE(row.contains(key)) << key;
        EXPECT_TRUE(row[key].is_null()) << key;
    }
}

}  // namespace planemap::results
