// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/keyframe_choice.hpp"

#include <gtest/gtest.h>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

Pose right_by(double metres) {
    Pose pose = Pose::Identity();
    pose.translation().x() = metres;
    return pose;
}

Located located_at(const Pose& odom_from_camera) {
    Located located;
    located.keyframe_id = 0;
    located.move_to(odom_from_camera);
    return located;
}

const OdometryOptions kOptions;

TEST(KeyframeChoiceTest, FarIsFarInMetresOrRadians) {
    EXPECT_FALSE(has_moved(kOptions, located_at(Pose::Identity())));
    EXPECT_FALSE(has_moved(kOptions, located_at(right_by(0.99 * kOptions.max_translation_m))));
    EXPECT_TRUE(has_moved(kOptions, located_at(right_by(1.01 * kOptions.max_translation_m))));
    Pose turned = Pose::Identity();
    turned.linear() = so3_exp({0, 1.01 * kOptions.max_rotation_rad, 0});
    EXPECT_TRUE(has_moved(kOptions, located_at(turned)));
}

TEST(KeyframeChoiceTest, CornersOrDepthCanBeTrackedAgainst) {
    const SeenFrame room(Pose::Identity()), plain(Pose::Identity(), 0, false), black(black_frame());
    EXPECT_TRUE(can_be_tracked_against(room.keyframe(), 30));
    EXPECT_TRUE(can_be_tracked_against(plain.keyframe(), 30)) << "by its depth";
    EXPECT_FALSE(can_be_tracked_against(black.keyframe(), 30));
    EXPECT_FALSE(can_be_tracked_against(LocalKeyframe{}, 30));
}

TEST(KeyframeChoiceTest, OverlapIsOfCornersOrOfSamples) {
    const SeenFrame room(Pose::Identity());
    const LocalKeyframe keyframe = room.keyframe();
    Track track;
    for (const bool by_features : {true, false}) {
        track.by_features = by_features;
        const std::size_t all = by_features ? keyframe.points.size() : room.frame.samples.size();
        track.inliers = static_cast<int>(0.9 * static_cast<double>(all));
        EXPECT_FALSE(has_lost_overlap(kOptions, keyframe, room.frame, track));
        track.inliers = static_cast<int>(0.3 * static_cast<double>(all));
        EXPECT_TRUE(has_lost_overlap(kOptions, keyframe, room.frame, track));
    }
}

TEST(KeyframeChoiceTest, TheSameViewIsNotWorthAKeyframe) {
    const SeenFrame room(Pose::Identity());
    const LocalKeyframe keyframe = room.keyframe();
    Located located = located_at(Pose::Identity());
    located.track.inliers = static_cast<int>(room.frame.samples.size());
    EXPECT_FALSE(is_worth_it(kOptions, keyframe, room.frame, located, keyframe)) << "by depth";
    located.track.by_features = true;
    located.track.inliers = static_cast<int>(keyframe.points.size());
    EXPECT_FALSE(is_worth_it(kOptions, keyframe, room.frame, located, keyframe)) << "by features";
    located.track.inliers -= 1;
    EXPECT_TRUE(is_worth_it(kOptions, keyframe, room.frame, located, keyframe)) << "a corner more";
    located.relocalised = true;
    EXPECT_TRUE(is_worth_it(kOptions, keyframe, room.frame, located, LocalKeyframe{}));
}

TEST(KeyframeChoiceTest, CornersWhereThereWereNoneAreWorthAKeyframe) {
    const SeenFrame dark(Pose::Identity(), 0, false), lit(Pose::Identity());
    Located located = located_at(Pose::Identity());
    located.track.inliers = static_cast<int>(lit.frame.samples.size());
    EXPECT_TRUE(is_worth_it(kOptions, dark.keyframe(), lit.frame, located, lit.keyframe()));
}

TEST(KeyframeChoiceTest, TrackingReturnsToTheNearestOtherKeyframe) {
    const SeenFrame origin(Pose::Identity()), right(right_by(0.3)), far(right_by(0.8));
    LocalKeyframes keyframes(5);
    keyframes.add(origin.keyframe(0));
    keyframes.add(right.keyframe(1, right_by(0.3)));
    keyframes.add(far.keyframe(2, right_by(0.8)));
    const SeenFrame seen(right_by(0.02));
    const auto other =
        find_other_keyframe(kOptions, keyframes, seen.frame, located_at(right_by(0.02)), Twist::Zero());
    ASSERT_TRUE(other);
    EXPECT_EQ(other->id, 0);
    EXPECT_LT(pose_error(other->track.alignment.camera_from_keyframe, right_by(-0.02)), 3e-3);
}

TEST(KeyframeChoiceTest, AKeyframeOfWhichNothingIsSeenIsNotReturnedTo) {
    const SeenFrame origin(Pose::Identity()), right(right_by(0.3)), plain(Pose::Identity(), 0, false);
    LocalKeyframes keyframes(5);
    keyframes.add(origin.keyframe(0));
    keyframes.add(right.keyframe(1, right_by(0.3)));
    const Located here = located_at(Pose::Identity());
    EXPECT_TRUE(find_other_keyframe(kOptions, keyframes, origin.frame, here, Twist::Zero()));
    EXPECT_FALSE(find_other_keyframe(kOptions, keyframes, plain.frame, here, Twist::Zero()));
}

TEST(KeyframeChoiceTest, NeitherThePresentNorAFarOneIsReturnedTo) {
    const SeenFrame origin(Pose::Identity()), far(right_by(0.8));
    LocalKeyframes keyframes(5);
    keyframes.add(far.keyframe(2, right_by(0.8)));
    keyframes.add(origin.keyframe(0));
    const Located here = located_at(Pose::Identity());
    EXPECT_FALSE(find_other_keyframe(kOptions, keyframes, origin.frame, here, Twist::Zero()));
    SeenFrame colourless(Pose::Identity());
    colourless.forget_color();
    keyframes.make_current(2);
    EXPECT_FALSE(find_other_keyframe(kOptions, keyframes, colourless.frame, here, Twist::Zero()));
    EXPECT_TRUE(find_other_keyframe(kOptions, keyframes, origin.frame, here, Twist::Zero()));
}

}  // namespace
}  // namespace planemap::odometry
