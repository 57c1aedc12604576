// SPDX-License-Identifier: BSD-3-Clause
#include "map/earlier_map.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap::map {
namespace {

TEST(EarlierMap, HasTwoNamesUntilItIsReplacedAndTheNewestFiveAreKept) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "plane_map.lcmlog";
    write_file(folder / "plane_map.earlier-notes.txt", "foreign");
    const auto start = std::filesystem::file_time_type::clock::now();
    for (int i = 0; i < 9; ++i) {
        write_file(file, "map " + std::to_string(i));
        std::filesystem::last_write_time(file, start + std::chrono::seconds(10 * (i / 2)));
        const KeptMap kept = keep_earlier_map(file);
        EXPECT_EQ(read_file(file), "map " + std::to_string(i));
        EXPECT_EQ(read_file(kept.file), "map " + std::to_string(i));
        EXPECT_EQ(kept.file.extension(), ".lcmlog");
        EXPECT_EQ(kept.removed.size(), i < 5 ? 0u : 1u);
        EXPECT_EQ(keep_earlier_map(file).file, kept.file) << "once is enough";
    }
    std::set<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        left.insert(read_file(entry.path()));
    EXPECT_EQ(left, (std::set<std::string>{"foreign", "map 4", "map 5", "map 6", "map 7", "map 8"}));
}

TEST(EarlierMap, WhatIsNotThereIsAnErrorThatNamesIt) {
    const test::TemporaryFolder folder;
    try {
        keep_earlier_map(folder / "no.lcmlog");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("no.lcmlog"), std::string::npos);
    }
}

}  // namespace
}  // namespace planemap::map
