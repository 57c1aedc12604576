// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/readout.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace planemap::odometry {
namespace {

/// What a frame says that was aligned with `used_s` and sees `true_s`, that well.
AlignmentResult saying(double used_s, double true_s, double sigma_s) {
    AlignmentResult result;
    result.readout_information = 1 / (sigma_s * sigma_s);
    result.readout_gradient = result.readout_information * (used_s - true_s);
    return result;
}

TEST(ReadoutTest, IsNoneUntilToldOtherwise) {
    EXPECT_EQ(Readout().seconds(), 0);
    Readout readout;
    readout.learn(0, AlignmentResult{});
    EXPECT_EQ(readout.seconds(), 0);
}

TEST(ReadoutTest, IsTheMeanOfWhatFramesSay) {
    Readout readout;
    for (int i = 0; i < 100; ++i)
        readout.learn(readout.seconds(), saying(readout.seconds(), i % 2 == 0 ? 0.018 : 0.022, 0.001));
    EXPECT_NEAR(readout.seconds(), 0.02, 5e-4);
}

TEST(ReadoutTest, StaysPossible) {
    Readout readout;
    for (int i = 0; i < 10; ++i) readout.learn(0, saying(0, 3, 1e-4));
    EXPECT_LE(readout.seconds(), 0.05);
    AlignmentResult broken;
    broken.readout_information = std::numeric_limits<double>::quiet_NaN();
    readout.learn(0, broken);
    EXPECT_LE(readout.seconds(), 0.05);
}

}  // namespace
}  // namespace planemap::odometry
