// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/pose_judge.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"

namespace planemap::bench_odometry {
namespace {

using Verdict = Judgement::Verdict;

Matrix6d covariance(double metres, double degrees) {
    Twist variances;
    variances << Eigen::Vector3d::Constant(metres * metres),
        Eigen::Vector3d::Constant(radians(degrees) * radians(degrees));
    return variances.asDiagonal();
}

Pose at(double x, double turned_deg = 0) {
    Twist twist;
    twist << x, 0, 0, 0, radians(turned_deg), 0;
    return pose_from_twist(twist);
}

/// A camera that goes 10 cm a frame along x, whose truth has another world frame; keyframe 0 is frame 0.
struct Walk {
    std::vector<ToldFrame> frames;
    std::vector<ToldKeyframe> keyframes{{0, -1, 0, Pose::Identity(), Matrix6d::Zero()}};

    explicit Walk(int count) {
        Twist elsewhere;
        elsewhere << 3, -2, 1, 0.4, 1.2, -0.7;
        for (int i = 0; i < count; ++i) {
            ToldFrame told;
            told.estimate.status = TrackingStatus::kTracked;
            told.estimate.keyframe_id = 0;
            told.estimate.odom_from_camera = told.estimate.keyframe_from_camera = at(0.1 * i);
            told.estimate.covariance = covariance(0.005, 0.2);
            told.truth = pose_from_twist(elsewhere) * at(0.1 * i);
            frames.push_back(told);
        }
    }
    OdometryEstimate& estimate(std::size_t i) { return frames[i].estimate; }
    /// From frame `first` on, everything is off by so much and against keyframe `id`.
    void move(std::size_t first, const Pose& error, int id = 0) {
        for (std::size_t i = first; i < frames.size(); ++i) {
            estimate(i).odom_from_camera = error * estimate(i).odom_from_camera;
            estimate(i).keyframe_id = id;
        }
    }
    Judgement judge(std::size_t frame, std::size_t first = 5) const {
        return PoseJudge(frames, keyframes, first).judge(frame);
    }
};

TEST(PoseJudge, HoldsPosesAgainstTheLastOneBefore) {
    Walk walk(10);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(walk.judge(i).verdict, Verdict::kRight);
    walk.move(0, at(4, 30));  // another odom frame changes nothing
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kRight);
    EXPECT_NEAR(walk.judge(9).metres, 0, 1e-9);
    walk.move(6, at(0.09));
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kRight);
    EXPECT_NEAR(walk.judge(9).metres, 0.09, 1e-9);
    walk.move(7, at(0.05));
    EXPECT_EQ(walk.judge(6).verdict, Verdict::kRight);
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kWrong);
}

TEST(PoseJudge, FiveDegreesAreTooMany) {
    Walk walk(10);
    Walk other = walk;
    walk.estimate(8).odom_from_camera = walk.estimate(8).odom_from_camera * at(0, 4.9);
    EXPECT_EQ(walk.judge(8).verdict, Verdict::kRight);
    EXPECT_NEAR(walk.judge(8).degrees, 4.9, 1e-6);
    other.estimate(8).odom_from_camera = other.estimate(8).odom_from_camera * at(0, 5.1);
    EXPECT_EQ(other.judge(8).verdict, Verdict::kWrong);
}

TEST(PoseJudge, DriftBeforeTheMomentIsNotItsFault) {
    Walk walk(10);
    walk.move(3, at(1));
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kRight);
}

TEST(PoseJudge, WhatIsAdmittedIsNotWrong) {
    Walk walk(10);
    walk.move(6, at(0.3));
    for (const auto status : {TrackingStatus::kDegenerate, TrackingStatus::kStale}) {
        walk.estimate(8).status = status;
        walk.estimate(8).covariance = covariance(0.02, 0.2);
        EXPECT_EQ(walk.judge(8).verdict, Verdict::kWrong) << "15 sigma";
        walk.estimate(8).covariance = covariance(0.15, 0.2);
        EXPECT_EQ(walk.judge(8).verdict, Verdict::kAdmitted) << "2 sigma";
    }
    walk.estimate(8).status = TrackingStatus::kTracked;
    EXPECT_EQ(walk.judge(8).verdict, Verdict::kWrong) << "not said";
}

TEST(PoseJudge, LostAndUnknownAreNoPoses) {
    Walk walk(10);
    walk.move(6, at(3));
    walk.estimate(7).status = TrackingStatus::kLost;
    EXPECT_EQ(walk.judge(7).verdict, Verdict::kNoPose);
    for (const Matrix6d& wide : {covariance(0.21, 0.1), covariance(0.01, 10.5)}) {
        walk.estimate(8).covariance = wide;
        EXPECT_EQ(walk.judge(8).verdict, Verdict::kNoPose);
    }
    walk.estimate(8).covariance(2, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(walk.judge(8).verdict, Verdict::kNoPose);
}

TEST(PoseJudge, SaysNothingWithoutTruth) {
    Walk walk(10);
    walk.frames[8].truth.reset();
    EXPECT_EQ(walk.judge(8).verdict, Verdict::kUnknown);
}

TEST(PoseJudge, APartWithoutAnEdgeIsHeldAgainstItself) {
    Walk walk(10);
    walk.keyframes.push_back({1, -1, 6, Pose::Identity(), Matrix6d::Zero()});
    walk.move(6, at(3, 50), 1);
    EXPECT_EQ(walk.judge(6).verdict, Verdict::kRight);
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kRight);
    EXPECT_EQ(walk.judge(9).part, 1);
    EXPECT_EQ(PoseJudge(walk.frames, walk.keyframes, 5).parts_begun(), 1);
    walk.move(8, at(0.2), 1);
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kWrong);
    walk.move(8, at(0), 0);  // and back against keyframe 0, where it is not
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kWrong);
    EXPECT_EQ(walk.judge(9).part, 0);
}

TEST(PoseJudge, AnEdgeClaimsARelationUnlessItIsTooWide) {
    Walk walk(10);
    walk.keyframes.push_back({1, 0, 6, at(3.6), covariance(0.01, 0.3)});
    walk.move(6, at(3), 1);
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kWrong);
    walk.keyframes[1].covariance = covariance(1, 0.3);
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kRight);
    EXPECT_EQ(PoseJudge(walk.frames, walk.keyframes, 5).parts_begun(), 1);
}

TEST(PoseJudge, AKeyframeOfADegenerateFrameMarksWhatComesAfter) {
    Walk walk(10);
    walk.keyframes.push_back({1, 0, 6, at(0.9), covariance(0.15, 0.3)});
    walk.move(6, at(0.3), 1);
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kWrong);
    walk.estimate(6).status = TrackingStatus::kDegenerate;
    EXPECT_EQ(walk.judge(9).verdict, Verdict::kAdmitted);
    // Frames of one part after it know each other as well as ever.
    EXPECT_EQ(walk.judge(9, 8).verdict, Verdict::kRight);
    walk.move(9, at(0.3), 1);
    EXPECT_EQ(walk.judge(9, 8).verdict, Verdict::kWrong);
}

TEST(PoseJudge, ARotationOfAFarKeyframeIsAWideDistance) {
    // 2 deg at 5 m are 0.17 m.
    Walk walk(60);
    walk.keyframes.push_back({1, 0, 6, at(0.6), covariance(0.01, 2)});
    for (std::size_t i = 6; i < 60; ++i) walk.estimate(i).keyframe_id = 1;
    walk.estimate(6).status = TrackingStatus::kDegenerate;
    walk.estimate(55).odom_from_camera.translation().z() += 0.3;
    EXPECT_EQ(walk.judge(55).verdict, Verdict::kAdmitted);
    walk.estimate(8).odom_from_camera.translation().z() += 0.3;
    EXPECT_EQ(walk.judge(8).verdict, Verdict::kWrong);
}

TEST(Nees, IsOneAValueAtOneSigma) {
    Twist error;
    error << 0.01, -0.01, 0.01, radians(1), radians(1), -radians(1);
    EXPECT_NEAR(*nees_of(error, covariance(0.01, 1)), 6, 1e-9);
    EXPECT_NEAR(*nees_of(error, covariance(0.02, 2)), 1.5, 1e-9);
    EXPECT_FALSE(nees_of(error, Matrix6d::Zero()));
    EXPECT_TRUE(is_within(error, covariance(0.01, 1), 3));
    EXPECT_FALSE(is_within(3 * error, covariance(0.01, 1), 3));
    EXPECT_TRUE(is_within(Twist::Zero(), Matrix6d::Zero(), 3));
    EXPECT_FALSE(is_within(error, Matrix6d::Zero(), 3));
}

}  // namespace
}  // namespace planemap::bench_odometry
