// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/position_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

class PositionFileTest : public testing::Test {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "played";
};

TEST_F(PositionFileTest, AnotherProcessReadsWhatWasKeptTenTimesASecond) {
    PositionFile position(file_);
    EXPECT_FALSE(position.read());
    EXPECT_TRUE(position.keep(1700000000000000, 1000000));
    EXPECT_TRUE(position.keep(1700000000033333, 1050000));
    EXPECT_EQ(PositionFile(file_).read(), 1700000000000000) << "not due yet";
    EXPECT_TRUE(position.keep(5, 1100000));
    EXPECT_EQ(PositionFile(file_).read(), 5) << "a shorter one over a longer one";
    position.remove();
    EXPECT_FALSE(PositionFile(file_).read());
}

TEST_F(PositionFileTest, WhatIsNoStampIsNone) {
    std::ofstream(file_) << "half of";
    EXPECT_FALSE(PositionFile(file_).read());
}

TEST_F(PositionFileTest, WhatCannotBeWrittenIsSaid) {
    EXPECT_FALSE(PositionFile(folder_.path() / "none" / "played").keep(1, 1000000));
}

TEST_F(PositionFileTest, WithoutAFileNothingIsKept) {
    PositionFile position{std::filesystem::path()};
    EXPECT_TRUE(position.keep(1, 1000000));
    EXPECT_FALSE(position.read());
    position.remove();
}

}  // namespace
}  // namespace planemap::sensor
