// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/motion_priors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

#include "odometry/odometry.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kStart = 1000000, kFrame_us = 33333;

/// The optical axis is the body's x.
Pose body_from_camera() {
    return make_pose({0.2, 0, 0.5}, Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5));
}

/// How the body lies when the camera is at a place.
Pose local_from_body(const Pose& odom_from_camera) {
    return body_from_camera() * odom_from_camera * body_from_camera().inverse();
}

Pose at(const Eigen::Vector3d& translation) {
    return make_pose(translation, Eigen::Quaterniond::Identity());
}

/// A frame that was tracked at camera_from_keyframe; along x nothing but the prediction tells, if so.
Track tracked_at(const Pose& camera_from_keyframe, bool blind_along_x) {
    Track track;
    track.guess_information = Twist::Constant(1 / (0.014 * 0.014)).asDiagonal();
    Twist data = Twist::Constant(1 / (0.001 * 0.001));
    if (blind_along_x) data[0] = 0;
    track.alignment.information = track.guess_information;
    track.alignment.information.diagonal() += data;
    track.alignment.camera_from_keyframe = camera_from_keyframe;
    track.degenerate = blind_along_x;
    return track;
}

/// Priors of a camera that moves by `step` a frame, for `frames` frames.
void hear_walk(MotionPriors& priors, const Eigen::Vector3d& step, int frames) {
    for (int i = 0; i < frames; ++i)
        EXPECT_TRUE(priors.hear({kStart + kFrame_us * i, local_from_body(at(i * step))}));
}

TEST(MotionPriors, FillWhatTheCameraDoesNotSee) {
    MotionPriors priors(MotionPriorOptions{});
    hear_walk(priors, {0.02, 0, 0}, 6);
    Track track = tracked_at(at({0, 0.0005, 0}), true);  // 10 cm off along x
    const Matrix6d before = track.alignment.information;
    EXPECT_EQ(priors.apply(track, kStart, kStart + 5 * kFrame_us, body_from_camera()), PriorUse::kFilled);
    const Eigen::Vector3d moved = track.alignment.camera_from_keyframe.translation();
    EXPECT_NEAR(moved.x(), -0.1, 1e-6);
    EXPECT_NEAR(moved.y(), 0.0005, 1e-6) << "what is seen stays";
    EXPECT_NEAR(std::sqrt(1 / track.alignment.information(0, 0)), 0.008, 0.001) << "5 % of 10 cm, and 3 mm";
    EXPECT_NEAR(track.alignment.information(1, 1), before(1, 1), 1e-6 * before(1, 1));
    // Between two that were heard, and a little after the last one.
    track = tracked_at(Pose::Identity(), true);
    EXPECT_EQ(priors.apply(track, kStart, kStart + 5 * kFrame_us / 2, body_from_camera()), PriorUse::kFilled);
    EXPECT_NEAR(track.alignment.camera_from_keyframe.translation().x(), -0.05, 1e-4);
    track = tracked_at(Pose::Identity(), true);
    EXPECT_EQ(priors.apply(track, kStart, kStart + 7 * kFrame_us, body_from_camera()), PriorUse::kFilled);
    EXPECT_NEAR(track.alignment.camera_from_keyframe.translation().x(), -0.14, 1e-6) << "carried on";
}

TEST(MotionPriors, LeaveAPoseThatIsSeen) {
    MotionPriors priors(MotionPriorOptions{});
    hear_walk(priors, {0.02, 0, 0}, 6);
    Track track = tracked_at(at({-0.1, 0, 0}), false);
    const Track before = track;
    EXPECT_EQ(priors.apply(track, kStart, kStart + 5 * kFrame_us, body_from_camera()), PriorUse::kNotNeeded);
    EXPECT_EQ(track.alignment.camera_from_keyframe.matrix(), before.alignment.camera_from_keyframe.matrix());
    EXPECT_EQ(track.alignment.information, before.alignment.information);
}

TEST(MotionPriors, ThatLieLoseAndAreNotTrustedForAWhile) {
    MotionPriors priors(MotionPriorOptions{});
    hear_walk(priors, {0.02, 0, 0}, 6);
    const auto apply = [&](const Pose& pose, bool blind) {
        Track track = tracked_at(pose, blind);
        const PriorUse use = priors.apply(track, kStart, kStart + 5 * kFrame_us, body_from_camera());
        if (use != PriorUse::kFilled) {
            EXPECT_EQ(track.alignment.camera_from_keyframe.matrix(), pose.matrix()) << "as it was";
        }
        return use;
    };
    EXPECT_EQ(apply(at({0.1, 0, 0}), false), PriorUse::kContradictory) << "20 cm";
    EXPECT_EQ(apply(Pose::Identity(), true), PriorUse::kFilled) << "once is no habit";
    EXPECT_EQ(apply(at({0, 0.1, 0}), true), PriorUse::kContradictory) << "in a direction that is seen";
    EXPECT_EQ(apply(Pose::Identity(), true), PriorUse::kDistrusted);
    for (int i = 0; i < 50; ++i)
        EXPECT_EQ(apply(Pose::Identity(), true), PriorUse::kDistrusted) << "half blind";
    int needed = 0;
    while (apply(at({-0.1, 0, 0}), false) == PriorUse::kDistrusted) ++needed;
    EXPECT_LT(needed, 30);
    EXPECT_EQ(apply(Pose::Identity(), true), PriorUse::kFilled) << "frames that see all agreed with it";
}

TEST(MotionPriors, WithoutAWordThereIsNone) {
    MotionPriors priors(MotionPriorOptions{});
    Track track = tracked_at(Pose::Identity(), true);
    EXPECT_EQ(priors.apply(track, kStart, kStart, body_from_camera()), PriorUse::kNone);
    hear_walk(priors, {0.02, 0, 0}, 6);
    EXPECT_EQ(priors.apply(track, kStart, kStart + kFrame_us, std::nullopt), PriorUse::kNoMount);
    EXPECT_EQ(priors.apply(track, kStart - 1, kStart + kFrame_us, body_from_camera()), PriorUse::kStale);
    EXPECT_EQ(priors.apply(track, kStart, kStart + 400000, body_from_camera()), PriorUse::kStale);
    EXPECT_TRUE(priors.hear({kStart + 1000000, Pose::Identity()}));
    EXPECT_EQ(priors.apply(track, kStart, kStart + 600000, body_from_camera()), PriorUse::kStale) << "a gap";
    EXPECT_EQ(track.alignment.camera_from_keyframe.matrix(), Pose::Identity().matrix());
}

TEST(MotionPriors, WhatIsNoneIsLeftOut) {
    MotionPriors priors(MotionPriorOptions{});
    hear_walk(priors, {0.02, 0, 0}, 3);
    EXPECT_FALSE(priors.hear({kStart + 2 * kFrame_us, Pose::Identity()})) << "twice";
    Pose none = Pose::Identity();
    none.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(priors.hear({kStart + 9 * kFrame_us, none}));
    EXPECT_TRUE(priors.hear({5, Pose::Identity()})) << "time goes back: it begins anew";
    Track track = tracked_at(Pose::Identity(), true);
    EXPECT_EQ(priors.apply(track, kStart, kStart + kFrame_us, body_from_camera()), PriorUse::kStale);
}

/// A walk of 60 frames along a blank wall, seen by depth alone, which cannot tell.
class Slide : public testing::Test {
  protected:
    Slide() {
        camera_.depth = camera_.color = {160, 120, 130, 130, 79.5, 59.5};
        camera_.body_from_camera = body_from_camera();
    }
    static constexpr int kFrames = 60;
    static constexpr double kStep_m = 0.01;

    DepthImage wall(std::uint64_t seed) const {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> noise(0, 3);
        DepthImage depth(160, 120);
        for (auto& raw : depth.pixels) raw = static_cast<std::uint16_t>(std::lround(1800 + noise(random)));
        return depth;
    }
    OdometryResult frame(Odometry& odometry, int i) const {
        const DepthImage depth = wall(static_cast<std::uint64_t>(i) + 1);
        OdometryFrame in;
        in.utime = kStart + kFrame_us * i;
        in.depth = &depth;
        in.camera = &camera_;
        return odometry.process(in);
    }
    CameraInfo camera_;
};

TEST_F(Slide, AlongABlankWallIsFollowedByThePrior) {
    Odometry odometry{OdometryOptions()};
    OdometryResult last;
    for (int i = 0; i < kFrames; ++i) {
        EXPECT_TRUE(odometry.hear({kStart + kFrame_us * i, local_from_body(at({kStep_m * i, 0, 0}))}));
        last = frame(odometry, i);
        EXPECT_EQ(last.prior, i > 0 ? PriorUse::kFilled : PriorUse::kNone) << i;
        if (i == 0) continue;
        EXPECT_EQ(Eigen::LLT<Matrix6d>(last.estimate.covariance).info(), Eigen::Success) << i;
    }
    EXPECT_EQ(last.estimate.status, TrackingStatus::kDegenerate) << "the camera does not see it";
    const Eigen::Vector3d moved = last.estimate.odom_from_camera.translation();
    EXPECT_NEAR(moved.x(), kStep_m * (kFrames - 1), 0.05);
    EXPECT_NEAR(moved.y(), 0, 0.05);
    EXPECT_NEAR(moved.z(), 0, 0.02);
    EXPECT_LT(std::sqrt(last.estimate.covariance(0, 0)), 0.06);
}

TEST_F(Slide, IsNotSeenWithoutOne) {
    Odometry odometry{OdometryOptions()};
    OdometryResult last;
    for (int i = 0; i < kFrames; ++i) last = frame(odometry, i);
    EXPECT_EQ(last.prior, PriorUse::kNone);
    EXPECT_EQ(last.estimate.status, TrackingStatus::kDegenerate);
}

}  // namespace
}  // namespace planemap::odometry
