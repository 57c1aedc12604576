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
    void remember() { remember(first_, 7, Pose::Identity()); }
    void remember(const SeenFrame& seen, int id, const Pose& odom_from_camera, int previous_id = -1) {
        Keyframe keyframe = make_keyframe(options_, seen.frame, {});
        keyframe.id = id;
        keyframe.previous_id = previous_id;
        keyframe.odom_from_camera = odom_from_camera;
        relocaliser_.add(keyframe);
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

Pose beside(double metres) {
    Pose pose = Pose::Identity();
    pose.translation().x() = metres;
    return pose;
}

TEST_F(RelocaliserTest, WhereTwoPlacesLookAlikeNeitherIsTaken) {
    constexpr std::int64_t kPause = 180 * kSecond;
    remember(first_, 7, Pose::Identity());
    const SeenFrame seen(small_motion(1), kPause);
    ASSERT_TRUE(relocaliser_.locate(seen.frame, motion_, local_));
    remember(first_, 8, beside(5), 7);
    EXPECT_FALSE(relocaliser_.locate(seen.frame, motion_, local_));
}

TEST_F(RelocaliserTest, APlaceSeenTwiceIsOnePlace) {
    remember(first_, 7, Pose::Identity());
    remember(SeenFrame(small_motion(2)), 8, small_motion(2), 7);
    const Pose room_from_camera = small_motion(1);
    const SeenFrame seen(room_from_camera, 180 * kSecond);
    const auto located = relocaliser_.locate(seen.frame, motion_, local_);
    ASSERT_TRUE(located);
    EXPECT_LT(pose_error(located->odom_from_camera(), room_from_camera), 0.02);
}

TEST_F(RelocaliserTest, TheOtherPlaceCountsOnlyIfTheCameraCanBeThere) {
    remember(first_, 7, Pose::Identity());
    remember(first_, 8, beside(50), 7);
    const Pose room_from_camera = small_motion(1);
    const SeenFrame soon(room_from_camera, kSecond / 10), late(room_from_camera, 180 * kSecond);
    const auto located = relocaliser_.locate(soon.frame, motion_, local_);
    ASSERT_TRUE(located);
    EXPECT_EQ(located->keyframe_id, 7) << "50 m in a tenth of a second";
    EXPECT_FALSE(relocaliser_.locate(late.frame, motion_, local_));
}

TEST_F(RelocaliserTest, AfterAPauseHowTwoPartsLieIsNotKnown) {
    remember(first_, 7, Pose::Identity());
    remember(first_, 8, small_motion(1), -1);
    EXPECT_TRUE(relocaliser_.locate(SeenFrame(Pose::Identity(), kSecond).frame, motion_, local_));
    EXPECT_FALSE(relocaliser_.locate(SeenFrame(Pose::Identity(), 180 * kSecond).frame, motion_, local_));
}

TEST_F(RelocaliserTest, AWallWhereACameraLookedThroughSpeaksAgainst) {
    const CameraInfo camera = room_camera();
    const RenderedFrame images = render_room(camera, Pose::Identity(), true, {room_planes()[0]});
    RenderedFrame farther = images;
    for (auto& reading : farther.depth.pixels) reading = static_cast<std::uint16_t>(reading * 3 / 2);
    const SeenFrame bare(images), seen(images, 180 * kSecond, {whole_view(camera, images.depth)});
    const SeenFrame through(farther, 0, {whole_view(camera, farther.depth)});
    remember(bare, 7, Pose::Identity());
    ASSERT_TRUE(relocaliser_.locate(seen.frame, motion_, local_));
    remember(through, 8, beside(0.2), 7);
    EXPECT_FALSE(relocaliser_.locate(seen.frame, motion_, local_)) << "another one saw 1.5 m farther there";
}

TEST_F(RelocaliserTest, NothingIsTriedWithoutTries) {
    options_.relocalisation_tries = 0;
    relocaliser_ = Relocaliser(options_);
    remember();
    EXPECT_FALSE(relocaliser_.locate(first_.frame, motion_, local_));
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
