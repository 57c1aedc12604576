// SPDX-License-Identifier: BSD-3-Clause
#include "results/progress_line.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(ProgressLine, IsALineOfItsOwnWhereThereIsNoTerminal) {
    testing::internal::CaptureStderr();
    {
        ProgressLine line(false, 0);
        EXPECT_TRUE(line.is_due());
        line.show("frame 1");
        line.show("frame 2");
        line.clear();
        line.end();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "frame 1\nframe 2\n");
}

TEST(ProgressLine, WaitsBetweenLinesAndIsQuietWhenAskedTo) {
    testing::internal::CaptureStderr();
    ProgressLine rare(false, 60), quiet(true, 0);
    EXPECT_FALSE(rare.is_due());
    EXPECT_FALSE(quiet.is_due());
    quiet.show("frame 1");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace planemap
