// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/planar_method.hpp"

#include <gtest/gtest.h>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

class PlanarMethodTest : public ::testing::Test {
  protected:
    PlanarMethodTest() {
        LocalKeyframe keyframe = first_.keyframe();
        method_.begin(first_.frame);
        method_.go_on_from(first_.frame, keyframe);
        keyframes_.add(std::move(keyframe));
        motion_.start(0);
    }
    std::optional<Located> locate(const SeenFrame& seen) {
        return method_.locate(seen.frame, {motion_, keyframes_, relocaliser_});
    }

    OdometryOptions options_;
    SeenFrame first_{Pose::Identity()};
    CameraMotion motion_{options_};
    LocalKeyframes keyframes_{3};
    Relocaliser relocaliser_{options_};
    PlanarMethod method_{options_};
};

TEST_F(PlanarMethodTest, FollowsFeaturesAndDepthAlone) {
    const Pose room_from_camera = small_motion(1);
    SeenFrame seen(room_from_camera, kPeriod);
    auto located = locate(seen);
    ASSERT_TRUE(located);
    EXPECT_TRUE(located->track.by_features);
    EXPECT_LT(pose_error(located->odom_from_camera(), room_from_camera), 3e-3);
    seen.forget_color();
    located = locate(seen);
    ASSERT_TRUE(located);
    EXPECT_FALSE(located->track.by_features);
    EXPECT_LT(pose_error(located->odom_from_camera(), room_from_camera), 3e-3);
}

TEST_F(PlanarMethodTest, DepthAloneIsNotFollowedOverALongGap) {
    SeenFrame seen(Pose::Identity(), 3000000);
    seen.forget_color();
    EXPECT_FALSE(locate(seen));
}

TEST_F(PlanarMethodTest, FeaturesAreLookedForNowAndThenWhereThereAreNone) {
    const SeenFrame plain(Pose::Identity(), kPeriod, false);
    Located by_depth;
    by_depth.track.inliers = static_cast<int>(plain.frame.samples.size());
    std::vector<bool> wanted;
    for (int i = 0; i < 17; ++i) {
        method_.follow(plain.frame, by_depth, 0.033);
        wanted.push_back(method_.wants_keyframe(plain.frame, by_depth, keyframes_.current()));
    }
    for (int i = 0; i < 17; ++i)
        EXPECT_EQ(wanted[static_cast<std::size_t>(i)], i < 2 || i == 7 || i == 15) << i;
    method_.lose();
    method_.follow(plain.frame, by_depth, 0.033);
    EXPECT_TRUE(method_.wants_keyframe(plain.frame, by_depth, keyframes_.current()));
    by_depth.track.inliers = 0;
    EXPECT_TRUE(method_.wants_keyframe(plain.frame, by_depth, keyframes_.current())) << "no overlap";
}

TEST_F(PlanarMethodTest, AMotionThatNobodyExpectedIsFoundByTheWholeImage) {
    Pose turned = Pose::Identity();
    turned.linear() = so3_exp({0, 0.2, 0});
    const SeenFrame seen(turned, kPeriod);
    const auto located = locate(seen);
    ASSERT_TRUE(located);
    EXPECT_LT(pose_error(located->odom_from_camera(), turned), 0.01);
}

}  // namespace
}  // namespace planemap::odometry
