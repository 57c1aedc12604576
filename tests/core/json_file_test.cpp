// SPDX-License-Identifier: BSD-3-Clause
#include "core/json_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string error_for(const std::string& text) {
    const test::TemporaryFolder folder;
    return test::error_of([&] { read_json_object(folder.write("a.json", text)); });
}

TEST(JsonFile, AnObjectIsRead) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(read_json_object(
                  folder.write("a.json", "\xef\xbb\xbf{\"a\": [{\"b\": 1}, {\"b\": 2}]}\r\n"))["a"][1]["b"],
              2);
}

TEST(JsonFile, SyntaxErrorsHaveLineAndColumn) {
    EXPECT_THAT(error_for("{\n  \"a\": 1,\n  \"b\" 2\n}"),
                AllOf(HasSubstr("a.json: line 3, column 7: syntax error"), Not(HasSubstr("json.exception"))));
    EXPECT_THAT(error_for("{\"a\": NaN}"), HasSubstr("line 1, column 7: syntax error"));
    EXPECT_THAT(error_for("{\n\"a\": 1,\n}"), HasSubstr("line 3, column 1"));
    EXPECT_THAT(error_for("{\n\n\"a\": 1e999}"), AllOf(HasSubstr("line 3, column 6"), HasSubstr("1e999")));
    EXPECT_THAT(error_for(""), HasSubstr("line 1, column 1"));
    EXPECT_THAT(error_for("{\"a\": 1"), HasSubstr("line 1"));
    EXPECT_THAT(error_for("[1]"), HasSubstr("not a JSON object"));
    EXPECT_THAT(error_for("{\"a\": \"\x1b[2J\"}"), Not(HasSubstr("\x1b")));
    EXPECT_LT(error_for("{\"a\": " + std::string(100000, 'x')).size(), 500u);
}

TEST(JsonFile, AKeyThatStandsTwiceIsAnError) {
    EXPECT_THAT(error_for(R"({"fx": 1, "b": {"fx": 2}, "fx": 3})"), HasSubstr("the key \"fx\" stands twice"));
    EXPECT_EQ(error_for(R"({"fx": 1, "b": {"fx": 2}, "c": [{"fx": 1}, {"fx": 2}]})"), "");
}

TEST(JsonFile, DepthIsBounded) {
    EXPECT_THAT(error_for("{\"a\": " + std::string(400000, '[')), HasSubstr("nested deeper"));
    std::string objects;
    for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
    EXPECT_THAT(error_for(objects), HasSubstr("nested deeper"));
    EXPECT_NE(error_for(std::string(2000000, ' ')), "") << "more than a person writes";
}

TEST(JsonFile, EveryTruncationAndChangedByteIsAnErrorOrAnObject) {
    const std::string text = R"({"a": {"b": [1.5, -2e3, true, null], "c": "\u00e9\n"}, "d": 5})";
    for (std::size_t i = 0; i < text.size(); ++i) {
        EXPECT_THAT(error_for(text.substr(0, i)), HasSubstr("a.json: line ")) << i;
        std::string damaged = text;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
        EXPECT_THAT(error_for(damaged), testing::AnyOf("", HasSubstr("a.json: "))) << i;
    }
}

}  // namespace
}  // namespace planemap
