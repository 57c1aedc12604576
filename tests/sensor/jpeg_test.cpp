// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/jpeg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensor/test_images.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

using testing::HasSubstr;

TEST(Jpeg, AWholeOnePasses) {
    const std::string jpeg = encode_jpeg(48, 32);
    EXPECT_EQ(test::error_of([&] { check_jpeg(jpeg, 48, 32); }), "");
    EXPECT_EQ(test::error_of([&] { check_jpeg(jpeg + std::string(3, '\0'), 48, 32); }), "");
}

TEST(Jpeg, WrongSizeAndOtherFilesAreNamed) {
    const std::string jpeg = encode_jpeg(48, 32);
    EXPECT_THAT(test::error_of([&] { check_jpeg(jpeg, 640, 480); }), HasSubstr("48x32"));
    EXPECT_THAT(test::error_of([&] { check_jpeg("", 48, 32); }), HasSubstr("not a JPEG"));
    EXPECT_THAT(test::error_of([&] { check_jpeg("\xff\xd8\xff\xff\xd9", 48, 32); }), HasSubstr("header"));
}

TEST(Jpeg, EveryTruncationIsAnError) {
    const std::string jpeg = encode_jpeg(48, 32);
    for (std::size_t size = 0; size < jpeg.size(); ++size) {
        EXPECT_NE(test::error_of([&] { check_jpeg(std::string_view(jpeg).substr(0, size), 48, 32); }), "")
            << size;
    }
}

}  // namespace
}  // namespace planemap::sensor
