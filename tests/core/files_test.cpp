// SPDX-License-Identifier: BSD-3-Clause
#include "core/files.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

TEST(Files, BytesSurvive) {
    const test::TemporaryFolder folder;
    std::string bytes;
    for (int i = 0; i < 100000; ++i) bytes.push_back(static_cast<char>(i * 31 % 256));
    write_file(folder / "a", bytes);
    EXPECT_EQ(read_file(folder / "a"), bytes);
    write_file(folder / "a", "");
    EXPECT_EQ(read_file(folder / "a"), "");
}

TEST(Files, WritingLeavesNothingBeside) {
    const test::TemporaryFolder folder;
    write_file(folder / "a", "one");
    write_file(folder / "a", "two");
    EXPECT_EQ(read_file(folder / "a"), "two");
    const auto entries = std::distance(std::filesystem::directory_iterator(folder.path()), {});
    EXPECT_EQ(entries, 1);
}

TEST(Files, FailureNamesTheFileAndKeepsTheOldOne) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(error_of([&] { read_file(folder / "missing"); }), HasSubstr("missing"));
    EXPECT_THAT(error_of([&] { read_file(folder.path()); }), HasSubstr("directory"));
    EXPECT_THAT(error_of([&] { write_file(folder / "none/a", "x"); }), HasSubstr("none/a"));
    EXPECT_NE(error_of([&] { write_file(folder.path(), "x"); }), "") << "the target is a folder";
    EXPECT_TRUE(std::filesystem::is_directory(folder.path()));
}

TEST(Files, AFailureTellsItsKind) {
    const test::TemporaryFolder folder;
    write_file(folder / "file", "x");
    try {
        write_file(folder / "file" / "below", "x");
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_EQ(error.code().value(), ENOTDIR);
    }
}

TEST(Files, APipeIsNotWaitedFor) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(error_of([&] { read_file(folder / "pipe"); }), HasSubstr("not a regular file"));
    EXPECT_THAT(error_of([&] { read_file("/dev/zero"); }), HasSubstr("not a regular file"));
    std::filesystem::create_symlink(folder / "loop", folder / "loop");
    EXPECT_THAT(error_of([&] { read_file(folder / "loop"); }), HasSubstr("loop: cannot open"));
}

TEST(Files, ADeviceIsWrittenToAndStaysWhatItIs) {
    const test::TemporaryFolder folder;
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    write_file(pipe, "hello");
    char bytes[8] = {};
    EXPECT_EQ(::read(reader, bytes, sizeof(bytes)), 5);
    EXPECT_STREQ(bytes, "hello");
    ::close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    EXPECT_THAT(error_of([] { write_file("/dev/full", "x"); }), HasSubstr("No space"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(Files, RefusesMoreThanTheLimit) {
    const test::TemporaryFolder folder;
    write_file(folder / "a", "0123456789");
    EXPECT_EQ(read_file(folder / "a", 10).size(), 10u);
    EXPECT_THAT(error_of([&] { read_file(folder / "a", 9); }), HasSubstr("10 bytes"));
}

}  // namespace
}  // namespace planemap
