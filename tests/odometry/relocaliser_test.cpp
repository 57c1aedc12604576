// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/relocaliser.hpp"

#include <gtest/gtest.h>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kSecond = 1000000;

class RelocaliserTest : public ::testing::Test {
  protected:
    /// Remembers the view of the room at its origin as keyframe 7.
    void remember() {
        Keyframe keyframe = make_keyframe(options_, first_.frame, {});
        keyframe.id = 7;
        relocaliser_.add(keyframe, first_.frame);
    }
    OdometryOptions options_;
    SeenFrame first_{Pose::Identity()};
    Relocaliser relocaliser_{options_};
    CameraMotion motion_{options_};
    LocalKeyframes local_{3};
};

TEST_F(RelocaliserTest, AKnownPlaceIsFoundAgain) {
    remember();
    for (int seed = 0; seed < 3; ++seed) {
        const Pose room_from_camera = small_motion(seed, 2);
        const SeenFrame seen(room_from_camera, kSecond);
        const auto located = relocaliser_.locate(seen.frame, motion_, local_);
        ASSERT_TRUE(located);
        EXPECT_EQ(located->keyframe_id, 7);
        EXPECT_TRUE(located->relocalised);
        EXPECT_TRUE(located->track.by_features);
        EXPECT_LT(pose_error(located->odom_from_camera(), room_from_camera), 0.02);
    }
}

TEST_F(RelocaliserTest, ALocalKeyframeIsTrackedAgainst) {
    remember();
    local_.add(first_.keyframe(7));
    local_.add(first_.keyframe(8));
    const Pose room_from_camera = small_motion(1, 2);
    const SeenFrame seen(room_from_camera, kSecond);
    const auto located = relocaliser_.locate(seen.frame, motion_, local_);
    ASSERT_TRUE(located);
    EXPECT_EQ(located->keyframe_id, 7);
    EXPECT_FALSE(located->relocalised);
    EXPECT_LT(pose_error(located->odom_from_camera(), room_from_camera), 3e-3);
}

TEST_F(RelocaliserTest, WhereTheCameraCannotBeItIsNot) {
    remember();
    Located far_away;
    Pose odom_from_camera = Pose::Identity();
    odom_from_camera.translation().x() = 50;
    far_away.move_to(odom_from_camera);
    motion_.start(kSecond);
    motion_.lose();
    motion_.follow(kSecond, far_away);
    const SeenFrame seen(Pose::Identity(), kSecond + 33333);
    EXPECT_FALSE(relocaliser_.locate(seen.frame, motion_, local_)) << "50 m in a thirtieth of a second";
}

TEST_F(RelocaliserTest, NothingIsFoundInNothing) {
    EXPECT_FALSE(relocaliser_.locate(first_.frame, motion_, local_)) << "nothing is remembered";
    remember();
    const SeenFrame black(black_frame(), kSecond), plain(Pose::Identity(), kSecond, false);
    EXPECT_FALSE(relocaliser_.locate(black.frame, motion_, local_));
    EXPECT_FALSE(relocaliser_.locate(plain.frame, motion_, local_));
    relocaliser_.clear();
    EXPECT_FALSE(relocaliser_.locate(first_.frame, motion_, local_));
}

}  // namespace
}  // namespace planemap::odometry
