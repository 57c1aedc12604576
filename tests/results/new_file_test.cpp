// SPDX-License-Identifier: BSD-3-Clause
#include "results/new_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

std::size_t entries(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(NewFile, IsWholeOrNotThere) {
    const test::TemporaryFolder folder;
    const auto file = folder / "deep/a.log";
    {
        NewFile left(file);
        write_file(left.part(), "half");
    }
    EXPECT_EQ(entries(folder / "deep"), 0u);
    NewFile kept(file);
    write_file(kept.part(), "whole");
    EXPECT_FALSE(std::filesystem::exists(file));
    kept.put_in_place();
    EXPECT_EQ(read_file(file), "whole");
    EXPECT_EQ(entries(folder / "deep"), 1u);
}

TEST(NewFile, NothingIsWrittenOver) {
    const test::TemporaryFolder folder;
    const auto file = folder / "a.log";
    NewFile late(file);
    write_file(late.part(), "late");
    write_file(file, "first");
    EXPECT_THAT(test::error_of([&] { late.put_in_place(); }), HasSubstr("a.log: is there already"));
    EXPECT_THAT(test::error_of([&] { NewFile again(file); }), HasSubstr("a.log: is there already"));
    EXPECT_THAT(test::error_of([&] { NewFile slash(folder / ""); }), HasSubstr("is a folder"));
    EXPECT_EQ(read_file(file), "first");
}

TEST(NewFolder, AnEmptyFolderCountsAsNone) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a");
    {
        NewFolder a(folder / "a");
        write_file(a.part() / "x", "x");
        a.put_in_place();
    }
    EXPECT_EQ(read_file(folder / "a/x"), "x");
    EXPECT_THAT(test::error_of([&] { NewFolder again(folder / "a"); }), HasSubstr("a: is there already"));
    EXPECT_EQ(entries(folder.path()), 1u);
}

}  // namespace
}  // namespace planemap
