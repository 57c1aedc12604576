// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/loose_keyframes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Keyframe held_to(double sigma_m, double sigma_rad, int previous_id = 3) {
    Keyframe keyframe;
    keyframe.id = 4;
    keyframe.utime = 2500000;
    keyframe.previous_id = previous_id;
    keyframe.covariance.diagonal() << sigma_m * sigma_m, 1e-6, 1e-6, 1e-8, sigma_rad * sigma_rad, 1e-8;
    return keyframe;
}

TEST(LooseKeyframes, WhatHangsByLittleIsSaidAndCounted) {
    messages::ModuleStatus status("odometry");
    LooseKeyframes loose(status);
    loose.see(held_to(0.09, 0.08));
    loose.see(held_to(4, 4, -1));
    EXPECT_THAT(status.remarks(), IsEmpty()) << "held, and a part of its own";
    loose.see(held_to(0.4, 0.001));
    EXPECT_THAT(status.remarks(), ElementsAre(HasSubstr("1, the last at 2.500 s")));
    loose.see(held_to(0.001, 0.2));
    EXPECT_THAT(status.remarks(), ElementsAre(HasSubstr("sigma): 2, the last")));
}

}  // namespace
}  // namespace planemap::odometry
