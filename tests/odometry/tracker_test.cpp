// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/tracker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

/// At the keyframe, known to about a decimetre.
Guess loose_guess() {
    Guess guess;
    guess.information = Matrix6d::Identity() * 100;
    return guess;
}

class TrackerTest : public ::testing::Test {
  protected:
    SeenFrame first_{Pose::Identity()};
    LocalKeyframe keyframe_ = first_.keyframe();
    OdometryOptions options_;
};

TEST_F(TrackerTest, PointsAndDepthFindTheMotion) {
    for (int seed = 0; seed < 3; ++seed) {
        const Pose room_from_camera = small_motion(seed);
        const SeenFrame seen(room_from_camera);
        const auto by_points = track_points(options_, keyframe_, seen.frame, loose_guess(), 4);
        ASSERT_TRUE(by_points);
        EXPECT_LT(pose_error(by_points->alignment.camera_from_keyframe, room_from_camera.inverse()), 3e-3);
        EXPECT_TRUE(by_points->by_features);
        EXPECT_FALSE(by_points->degenerate);
        EXPECT_EQ(by_points->inlier.size(), keyframe_.points.size());
        EXPECT_GE(by_points->tried, by_points->inliers);
        const auto by_depth = track_surface(options_, keyframe_, seen.frame, loose_guess());
        ASSERT_TRUE(by_depth);
        EXPECT_LT(pose_error(by_depth->alignment.camera_from_keyframe, room_from_camera.inverse()), 3e-3);
        EXPECT_FALSE(by_depth->by_features);
    }
}

TEST_F(TrackerTest, AFrameAgainstItselfHasNotMoved) {
    const auto track = track_points(options_, keyframe_, first_.frame, loose_guess(), 3);
    ASSERT_TRUE(track);
    EXPECT_LT(pose_error(track->alignment.camera_from_keyframe, Pose::Identity()), 1e-3);
    EXPECT_GT(track->inliers, 0.9 * static_cast<double>(keyframe_.points.size()));
}

TEST_F(TrackerTest, PointsThatAreNotUsableAreNotFollowed) {
    const std::vector<cv::Point2f> pixels = keyframe_.pixels();
    std::vector<char> usable(pixels.size(), 0);
    FlowSearch search{&keyframe_.pyramid, &pixels, &usable, 3};
    EXPECT_FALSE(track_points(options_, keyframe_, first_.frame, loose_guess(), search));
    for (std::size_t i = 0; i < usable.size() / 2; ++i) usable[i] = 1;
    const auto track = track_points(options_, keyframe_, first_.frame, loose_guess(), search);
    ASSERT_TRUE(track);
    for (std::size_t i = usable.size() / 2; i < usable.size(); ++i) EXPECT_EQ(track->inlier[i], 0);
}

TEST_F(TrackerTest, PointsAreCountedAsTheyAreTracked) {
    const SeenFrame seen(small_motion(1)), black(black_frame());
    const std::vector<cv::Point2f> pixels = keyframe_.pixels();
    std::vector<char> usable(pixels.size(), 0);
    const FlowSearch search{&keyframe_.pyramid, &pixels, &usable, 3};
    EXPECT_EQ(count_points(options_, keyframe_, seen.frame, loose_guess(), search), 0) << "none usable";
    for (std::size_t i = 0; i < usable.size(); i += 2) usable[i] = 1;
    const auto track = track_points(options_, keyframe_, seen.frame, loose_guess(), search);
    ASSERT_TRUE(track);
    const int counted = count_points(options_, keyframe_, seen.frame, loose_guess(), search);
    EXPECT_NEAR(counted, track->inliers, 0.05 * track->tried);
    EXPECT_LT(count_points(options_, keyframe_, black.frame, loose_guess(), search), options_.min_inliers);
    EXPECT_EQ(count_points(options_, LocalKeyframe{}, seen.frame, loose_guess(), search), 0);
    SeenFrame colourless(Pose::Identity());
    colourless.forget_color();
    EXPECT_EQ(count_points(options_, keyframe_, colourless.frame, loose_guess(), search), 0);
}

TEST_F(TrackerTest, NothingIsTrackedInNothing) {
    const SeenFrame black(black_frame());
    EXPECT_FALSE(track_points(options_, keyframe_, black.frame, loose_guess(), 3));
    EXPECT_FALSE(track_surface(options_, keyframe_, black.frame, loose_guess()));
    const LocalKeyframe empty = black.keyframe();
    EXPECT_TRUE(empty.points.empty());
    EXPECT_FALSE(track_points(options_, empty, first_.frame, loose_guess(), 3));
    EXPECT_FALSE(track_surface(options_, empty, first_.frame, loose_guess()));
    EXPECT_FALSE(track_points(options_, LocalKeyframe{}, first_.frame, loose_guess(), 3));
    SeenFrame colourless(Pose::Identity());
    colourless.forget_color();
    EXPECT_FALSE(track_points(options_, keyframe_, colourless.frame, loose_guess(), 3));
}

TEST_F(TrackerTest, OneWallLeavesDirectionsToTheGuess) {
    const SeenFrame wall(Pose::Identity(), 0, false, {{{0, 0, -1}, 2}});
    const auto track = track_surface(options_, wall.keyframe(), wall.frame, loose_guess());
    ASSERT_TRUE(track);
    EXPECT_TRUE(track->degenerate);
}

TEST_F(TrackerTest, WhereABareWallHoldsNothingDepthAloneGoesOnAsItWasGoing) {
    const auto noisy_wall = [](std::uint64_t seed) {
        RenderedFrame wall = render_room(room_camera(), Pose::Identity(), false, {{{0, 0, -1}, 2}});
        std::mt19937_64 random(seed);
        std::normal_distribution<double> noise(0, 25);  // of 5000 units a metre
        for (int v = 0; v < wall.depth.height; ++v)
            for (int u = 0; u < wall.depth.width; ++u)
                wall.depth(u, v) = static_cast<std::uint16_t>(wall.depth(u, v) + noise(random));
        return wall;
    };
    const auto sideways = [](const Track& track) {
        const Twist moved = twist_from_pose(track.alignment.camera_from_keyframe);
        return std::hypot(moved[0], moved[1], moved[5]);
    };
    Guess unknown;  // as a prediction is at 30 frames a second
    unknown.information.diagonal() << 5000, 5000, 5000, 1000, 1000, 1000;
    Guess known = unknown;
    known.velocity_gain.setConstant(30);  // at rest, as it was
    double by_noise = 0, held = 0;
    for (std::uint64_t seed = 1; seed < 9; seed += 2) {
        const SeenFrame before(noisy_wall(seed)), after(noisy_wall(seed + 1));
        const LocalKeyframe keyframe = before.keyframe();
        const auto led = track_surface(options_, keyframe, after.frame, unknown);
        const auto kept = track_surface(options_, keyframe, after.frame, known);
        ASSERT_TRUE(led && kept);
        EXPECT_TRUE(kept->degenerate);
        EXPECT_NEAR(kept->alignment.camera_from_keyframe.translation().z(), 0, 1e-3);
        by_noise += sideways(*led);
        held += sideways(*kept);
    }
    EXPECT_LT(held, 0.2 * by_noise) << held << " " << by_noise;
}

TEST_F(TrackerTest, TheWholeImageBringsAGuessNearer) {
    const Pose room_from_camera = small_motion(1, 3);
    const SeenFrame seen(room_from_camera);
    const DenseReference last =
        make_dense_reference(first_.frame.pyramid, *first_.frame.depth, *first_.frame.camera);
    const Guess better = coarse_guess(options_, keyframe_, seen.frame, loose_guess(), last, Pose::Identity());
    const Pose truth = room_from_camera.inverse();
    EXPECT_LT(pose_error(better.camera_from_keyframe, truth), 0.5 * pose_error(Pose::Identity(), truth));
    EXPECT_EQ(pose_error(coarse_guess(options_, keyframe_, seen.frame, loose_guess(), {}, Pose::Identity())
                             .camera_from_keyframe,
                         Pose::Identity()),
              0)
        << "without a last frame the guess stays";
}

TEST(GuessTest, TheVelocityFollowsWhereTheCameraIsFound) {
    Guess guess;
    guess.velocity << 1, 0, 0, 0, 0, 0;
    EXPECT_EQ(guess.velocity_at(small_motion(1)), guess.velocity) << "no gain";
    guess.velocity_gain.setConstant(10);
    EXPECT_LT((guess.velocity_at(guess.predicted_from_keyframe) - guess.velocity).norm(), 1e-12);
    Twist off = Twist::Zero();
    off[1] = 0.01;
    EXPECT_NEAR(guess.velocity_at(pose_from_twist(off) * guess.predicted_from_keyframe)[1], 0.1, 1e-9);
}

TEST(MatchPlanesTest, TheStepLeadsToTheTrueMotion) {
    const SeenFrame wall(Pose::Identity(), 0, true, {{{0, 0, -1}, 2}});
    const std::vector<PlanarRegion> regions{whole_view(*wall.frame.camera, *wall.frame.depth)};
    const DepthNoise& noise = wall.frame.camera->noise;
    const QuadraticTerm there = match_planes(regions, regions, Pose::Identity(), noise, 3);
    EXPECT_LT(there.gradient.norm(), 1e-6 * there.information.norm());
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix6d>(there.information).eigenvalues()[0],
              -1e-9 * there.information.norm());
    // A centimetre too near: the step goes back.
    Pose near = Pose::Identity();
    near.translation().z() = -0.01;
    const QuadraticTerm off = match_planes(regions, regions, near, noise, 3);
    EXPECT_NEAR(-off.gradient[2] / off.information(2, 2), 0.01, 1e-3);
    Pose far = Pose::Identity();
    far.translation().z() = 1;
    EXPECT_EQ(match_planes(regions, regions, far, noise, 3).information.norm(), 0) << "another plane";
    EXPECT_EQ(match_planes({}, regions, Pose::Identity(), noise, 3).information.norm(), 0);
    EXPECT_EQ(match_planes(regions, {}, Pose::Identity(), noise, 3).information.norm(), 0);
}

}  // namespace
}  // namespace planemap::odometry
