// SPDX-License-Identifier: BSD-3-Clause
#include "results/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

TEST(OutputFile, AnEarlierFileStaysUntilTheNewOneIsWhole) {
    const test::TemporaryFolder folder;
    write_file(folder / "rows.json", "[1, 2, 3]");
    {
        OutputFile output(folder / "rows.json");
        EXPECT_EQ(read_file(folder / "rows.json"), "[1, 2, 3]");
        output.keep("[4]");
        EXPECT_EQ(read_file(folder / "rows.json"), "[1, 2, 3]");
        output.finish("[4, 5]");
    }
    EXPECT_EQ(read_file(folder / "rows.json"), "[4, 5]");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(OutputFile, WhatAFailureLeavesIsKeptAndSaid) {
    const test::TemporaryFolder folder;
    write_file(folder / "rows.json", "[1, 2, 3]");
    testing::internal::CaptureStderr();
    try {
        OutputFile output(folder / "rows.json");
        output.keep("[4]");
        throw std::runtime_error("the next sequence fails");
    } catch (const std::runtime_error&) {
    }
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(read_file(folder / "rows.json"), "[1, 2, 3]");
    const std::size_t at = said.find((folder / "rows.json.part-").string());
    ASSERT_NE(at, std::string::npos) << said;
    const std::filesystem::path aside = said.substr(at, said.find('\n') - at);
    EXPECT_EQ(read_file(aside / "rows.json"), "[4]");

    // Without an earlier file there is nothing to protect.
    {
        OutputFile output(folder / "new.json");
        output.keep("[6]");
        EXPECT_EQ(read_file(folder / "new.json"), "[6]");
    }
    EXPECT_EQ(read_file(folder / "new.json"), "[6]");
}

TEST(OutputFile, WhatCannotBeWrittenIsAnErrorAtOnce) {
    const test::TemporaryFolder folder;
    const auto error_of = [](const std::filesystem::path& file) {
        return test::error_of([&] { const OutputFile output(file); });
    };
    EXPECT_THAT(error_of(folder.path()), HasSubstr("is a folder"));
    EXPECT_THAT(error_of(folder.path() / ""), HasSubstr("is a folder"));
    EXPECT_THAT(error_of("/proc/nowhere/rows.json"), HasSubstr("/proc/nowhere"));
    EXPECT_EQ(error_of("-"), "");
    EXPECT_EQ(error_of(""), "");
    OutputFile device("/dev/full");
    EXPECT_THROW(device.finish("[]"), std::runtime_error);
}

}  // namespace
}  // namespace planemap
