// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/feature_matching.hpp"

#include <gtest/gtest.h>

#include "odometry/features.hpp"
#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

std::vector<Feature> features_of(const SeenFrame& seen) {
    return describe(*seen.frame.gray, *seen.frame.depth, *seen.frame.camera, 500, 0.04);
}

TEST(FeatureMatchingTest, AFrameMatchesItself) {
    const SeenFrame seen(Pose::Identity());
    const std::vector<Feature> features = features_of(seen);
    const std::vector<PointTerm> matches = match_terms(features, features, seen.frame, 64);
    EXPECT_GT(matches.size(), 50u);
    for (const PointTerm& match : matches) {
        EXPECT_LT((seen.frame.camera->color.project(match.point) - match.pixel).norm(), 1e-3);
        EXPECT_NEAR(match.inverse_depth * match.point.z(), 1, 1e-6);
        EXPECT_GT(match.inverse_depth_sigma, 0);
    }
    const auto track = align_matches(seen.frame.camera->color, matches, Pose::Identity(), 20);
    ASSERT_TRUE(track);
    EXPECT_LT(pose_error(track->alignment.camera_from_keyframe, Pose::Identity()), 1e-4);
    EXPECT_EQ(track->tried, static_cast<int>(matches.size()));
}

TEST(FeatureMatchingTest, MatchesFindTheMotion) {
    const Pose room_from_camera = small_motion(1);
    const SeenFrame before(Pose::Identity()), after(room_from_camera);
    const auto matches = match_terms(features_of(before), features_of(after), after.frame, 64);
    const auto track = align_matches(after.frame.camera->color, matches, room_from_camera.inverse(), 20);
    ASSERT_TRUE(track);
    EXPECT_LT(pose_error(track->alignment.camera_from_keyframe, room_from_camera.inverse()), 0.02);
}

TEST(FeatureMatchingTest, TooFewAreNoPose) {
    const SeenFrame seen(Pose::Identity());
    std::vector<PointTerm> matches = match_terms(features_of(seen), features_of(seen), seen.frame, 64);
    matches.resize(19);
    EXPECT_FALSE(align_matches(seen.frame.camera->color, matches, Pose::Identity(), 20));
    EXPECT_FALSE(align_matches(seen.frame.camera->color, {}, Pose::Identity(), 1));
    EXPECT_TRUE(match_terms({}, features_of(seen), seen.frame, 64).empty());
    EXPECT_TRUE(match_terms(features_of(seen), {}, seen.frame, 64).empty());
}

TEST(FeatureMatchingTest, FeaturesOnARegionLieOnItsPlaneAndStayOnTheirPixel) {
    RenderedFrame images = render_room(room_camera(), Pose::Identity(), true, {{{0, 0, -1}, 2}});
    PlanarRegion wall = whole_view(room_camera(), images.depth);
    const SeenFrame seen(std::move(images), 0, {wall});
    std::vector<Feature> features = features_of(seen);
    for (Feature& feature : features) feature.point *= 1.001f;
    put_on_regions(features, seen.frame);
    ASSERT_GT(features.size(), 20u);
    int on = 0;
    for (const Feature& feature : features) {
        if (feature.region < 0) continue;
        ++on;
        const Eigen::Vector3d point = feature.point.cast<double>();
        EXPECT_NEAR(wall.plane.signed_distance(point), 0, 1e-5);
        EXPECT_LT((seen.frame.camera->color.project(point) - feature.pixel.cast<double>()).norm(), 1e-2);
    }
    EXPECT_GT(on, 20);
    const SeenFrame without(Pose::Identity());
    put_on_regions(features, without.frame);
    for (const Feature& feature : features) EXPECT_EQ(feature.region, -1);
}

}  // namespace
}  // namespace planemap::odometry
