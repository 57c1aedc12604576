// SPDX-License-Identifier: BSD-3-Clause
#include "core/text_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

TEST(TextFile, TheByteOrderMarkIsNotText) {
    const test::TemporaryFolder folder;
    write_file(folder / "a.txt", "\xef\xbb\xbfone\r\n");
    EXPECT_EQ(read_text_file(folder / "a.txt"), "one\r\n");
    write_file(folder / "a.txt", "\xef\xbb");
    EXPECT_EQ(read_text_file(folder / "a.txt"), "\xef\xbb");
    write_file(folder / "a.txt", "");
    EXPECT_EQ(read_text_file(folder / "a.txt"), "");
}

TEST(TextFile, Utf16IsNamed) {
    const test::TemporaryFolder folder;
    for (const std::string& text : {std::string("\xff\xfe{\0", 4), std::string("\xfe\xff\0{", 4)}) {
        write_file(folder / "a.txt", text);
        try {
            read_text_file(folder / "a.txt");
            FAIL();
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), HasSubstr("a.txt: UTF-16"));
        }
    }
    EXPECT_THROW(read_text_file(folder / "none"), std::runtime_error);
}

TEST(ShownText, IsOneShortLine) {
    EXPECT_EQ(shown_text("plain \xc3\xa9"), "plain \xc3\xa9");
    EXPECT_EQ(shown_text(std::string_view("a\nb\x1b[2J\0c\x7f", 10)), "a?b?[2J?c?");
    EXPECT_EQ(shown_text(std::string(1000, 'x'), 5), "xxxxx...");
    EXPECT_EQ(shown_text("", 5), "");
}

}  // namespace
}  // namespace planemap
