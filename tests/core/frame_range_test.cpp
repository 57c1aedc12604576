// SPDX-License-Identifier: BSD-3-Clause
#include "core/frame_range.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace planemap {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
    try {
        parse_frame_range(text);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "no error";
}

TEST(FrameRange, OpenEnds) {
    EXPECT_EQ(parse_frame_range("3:7").from, 3u);
    EXPECT_EQ(parse_frame_range("3:7").to, 7u);
    EXPECT_EQ(parse_frame_range("3:").from, 3u);
    EXPECT_FALSE(parse_frame_range("3:").to);
    EXPECT_EQ(parse_frame_range(":7").from, 0u);
    EXPECT_EQ(parse_frame_range(":7").to, 7u);
    EXPECT_TRUE(parse_frame_range(":").is_all());
}

TEST(FrameRange, BadOnesAreNamed) {
    for (const char* text :
         {"", "5", "a:3", "3:b", "-1:3", "1:2:3", "1.5:3", " 1:2", "+1:2", "99999999999999999999999:"})
        EXPECT_THAT(error_of(text), HasSubstr("frames \"" + std::string(text) + "\"")) << text;
    EXPECT_THAT(error_of("7:7"), HasSubstr("no frame lies in it"));
    EXPECT_THAT(error_of("7:3"), HasSubstr("no frame lies in it"));
    EXPECT_THAT(error_of(":0"), HasSubstr("no frame lies in it"));
}

TEST(FrameRange, WithinAnInput) {
    EXPECT_EQ(frames_within({2, 5}, 10), std::pair(std::size_t{2}, std::size_t{5}));
    EXPECT_EQ(frames_within({2, 50}, 10), std::pair(std::size_t{2}, std::size_t{10}));
    EXPECT_EQ(frames_within({}, 0), std::pair(std::size_t{0}, std::size_t{0}));
    EXPECT_THROW(frames_within({10, {}}, 10), std::invalid_argument);
}

}  // namespace
}  // namespace planemap
