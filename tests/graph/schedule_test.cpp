// SPDX-License-Identifier: BSD-3-Clause
#include "graph/schedule.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace planemap::graph {
namespace {

TEST(ScheduleTest, NothingNewAsksForNothing) {
    Schedule schedule{GraphOptions{}};
    EXPECT_FALSE(schedule.is_due());
    for (int nodes = 1; nodes < 500; ++nodes) schedule.keyframe_added({nodes, 0, false, 0});
    EXPECT_FALSE(schedule.is_due());
    EXPECT_FALSE(schedule.is_running());
}

TEST(ScheduleTest, AFarLoopClosureAsksAtOnceAndItStaysAsked) {
    Schedule schedule{GraphOptions{}};
    schedule.keyframe_added({5000, 0, true, 7});
    EXPECT_TRUE(schedule.is_due()) << "beyond two widths of the kernel, which are 6";
    schedule.keyframe_added({5001, 0, false, 0});
    EXPECT_TRUE(schedule.is_due());
    schedule.start();
    EXPECT_FALSE(schedule.is_due());
}

TEST(ScheduleTest, WhatPullsLessWaitsTheLongerTheLargerTheGraph) {
    const auto waits = [](int nodes, bool loops, double disagreement) {
        Schedule schedule{GraphOptions{}};
        int keyframes = 0;
        while (!schedule.is_due()) {
            schedule.keyframe_added({nodes, keyframes == 0 ? disagreement : 0, loops, 1});
            ++keyframes;
        }
        return keyframes;
    };
    EXPECT_EQ(waits(10, true, 0), 1);
    EXPECT_EQ(waits(500, true, 0), 11);
    EXPECT_EQ(waits(500, false, 3), 11) << "a disagreement is not forgotten";
}

TEST(ScheduleTest, EveryNthKeyframeWhenAskedFor) {
    GraphOptions options;
    options.optimise_every = 4;
    Schedule schedule(options);
    for (int nodes = 1; nodes < 4; ++nodes) schedule.keyframe_added({nodes, 0, false, 0});
    EXPECT_FALSE(schedule.is_due());
    schedule.keyframe_added({4, 0, false, 0});
    EXPECT_TRUE(schedule.is_due());
}

TEST(ScheduleTest, AResultHoldsUnlessAPartWasMovedMeanwhile) {
    Schedule schedule{GraphOptions{}};
    schedule.part_moved();
    int started = schedule.start();
    EXPECT_TRUE(schedule.is_running());
    EXPECT_TRUE(schedule.end(started));
    EXPECT_FALSE(schedule.is_running());
    EXPECT_FALSE(schedule.is_due());
    started = schedule.start();
    schedule.part_moved();
    EXPECT_FALSE(schedule.end(started));
    EXPECT_FALSE(schedule.is_running());
    EXPECT_TRUE(schedule.is_due()) << "asks again";
}

TEST(ScheduleTest, AnErrorThatIsNoNumberAsksForNothing) {
    Schedule schedule{GraphOptions{}};
    EXPECT_FALSE(schedule.is_far(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_TRUE(schedule.is_far(std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace planemap::graph
