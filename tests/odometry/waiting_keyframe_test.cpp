// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/waiting_keyframe.hpp"

#include <gtest/gtest.h>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

TEST(WaitingKeyframeTest, IsGivenOnceItIsDescribedAsOthersAre) {
    const SeenFrame seen(Pose::Identity(), 5);
    Relocaliser relocaliser(seen.options);
    WaitingKeyframe waiting(seen.options, relocaliser);
    waiting.describe();
    EXPECT_FALSE(waiting.take()) << "none waits";
    waiting.begin(seen.frame, {}).id = 7;
    EXPECT_FALSE(waiting.take()) << "not described yet";
    waiting.describe();
    const std::optional<Keyframe> keyframe = waiting.take();
    ASSERT_TRUE(keyframe);
    EXPECT_EQ(keyframe->id, 7);
    EXPECT_EQ(keyframe->utime, 5);
    EXPECT_EQ(keyframe->features.size(), make_keyframe(seen.options, seen.frame, {}).features.size());
    EXPECT_FALSE(waiting.take()) << "once";
}

TEST(WaitingKeyframeTest, OneThatIsNeededAtOnceDoesNotWait) {
    const SeenFrame seen(Pose::Identity());
    Relocaliser relocaliser(seen.options);
    WaitingKeyframe waiting(seen.options, relocaliser);
    waiting.begin(seen.frame, {}).id = 2;
    EXPECT_EQ(waiting.describe_at_once().id, 2);
    waiting.describe();
    EXPECT_FALSE(waiting.take());
}

}  // namespace
}  // namespace planemap::odometry
