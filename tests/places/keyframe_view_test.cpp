// SPDX-License-Identifier: BSD-3-Clause
#include "places/keyframe_view.hpp"

#include <gtest/gtest.h>

#include "places/synthetic.hpp"

namespace planemap::places {
namespace {

using namespace planemap::test;

KeyframeView view_at(const std::vector<Landmark>& room, const Pose& pose, Random& random) {
    Keyframe keyframe;
    keyframe.features = see(room, pose, random);
    return make_view(keyframe, 1000);
}

TEST(KeyframeView, KeepsSoundFeaturesOnlyAndAtMostSoMany) {
    Keyframe keyframe;
    for (int i = 0; i < 100; ++i) {
        Feature feature;
        feature.point = {0.01f * static_cast<float>(i), 0, i % 2 == 0 ? 2.0f : 0.0f};
        keyframe.features.push_back(feature);
    }
    EXPECT_EQ(make_view(keyframe, 1000).points.size(), 50u);
    const KeyframeView few = make_view(keyframe, 7);
    EXPECT_EQ(few.points.size(), 7u);
    EXPECT_EQ(few.descriptors.size(), 7u);
    EXPECT_GT(few.points.back().x(), 0.7) << "spread over all";
    for (const auto& p : few.points) EXPECT_TRUE(few.sees(p));
    EXPECT_TRUE(make_view(Keyframe{}, 10).points.empty());
}

TEST(KeyframeView, MeanDepthIsOfThePointsOrElseOfTheRegions) {
    KeyframeView view;
    EXPECT_EQ(mean_depth(view), 0);
    Pose wall = Pose::Identity();
    wall.linear() = so3_exp({M_PI, 0, 0});
    wall.translation().z() = 2;
    view.regions = {test::rectangle(wall, 1, 1)};
    EXPECT_NEAR(mean_depth(view), 2, 1e-9);
    view.points = {{0, 0, 3}, {1, 0, 4}};
    EXPECT_NEAR(mean_depth(view), 3.5, 1e-9);
}

TEST(KeyframeView, OverlapIsWholeForTheSamePoseAndNoneForTheOppositeOne) {
    Random random(1);
    const auto room = make_room(random, Eigen::Vector3d::Zero(), 3, 2000);
    const Pose here = looking(Eigen::Vector3d::Zero(), 0), back = looking(Eigen::Vector3d::Zero(), M_PI);
    const Pose aside = looking(Eigen::Vector3d::Zero(), 0.4);
    const KeyframeView a = view_at(room, here, random), b = view_at(room, back, random),
                       c = view_at(room, aside, random);
    EXPECT_DOUBLE_EQ(overlap(a, a, Pose::Identity()), 1.0);
    EXPECT_DOUBLE_EQ(overlap(a, b, here.inverse() * back), 0.0);
    const double partly = overlap(a, c, here.inverse() * aside);
    EXPECT_GT(partly, 0.4);
    EXPECT_LT(partly, 0.8);
    EXPECT_DOUBLE_EQ(overlap(a, KeyframeView{}, Pose::Identity()), 0.0);
    EXPECT_DOUBLE_EQ(overlap(KeyframeView{}, a, Pose::Identity()), 0.0);
}

TEST(KeyframeView, LooksAtTheSameOnlyFromNearby) {
    test::Random random(3);
    const auto room = test::make_room(random, Eigen::Vector3d::Zero(), 2.5, 1500);
    Keyframe keyframe;
    keyframe.features = test::see(room, Pose::Identity(), random);
    const KeyframeView view = make_view(keyframe, 1000);
    EXPECT_TRUE(looks_at_the_same(view, view, Pose::Identity()));
    EXPECT_TRUE(looks_at_the_same(view, view, test::looking({0.3, 0, 0.2}, 0.2)));
    EXPECT_FALSE(looks_at_the_same(view, view, test::looking({0, 0, 0}, 2.0)));
    EXPECT_FALSE(looks_at_the_same(view, view, test::looking({0, 0, 7}, 0))) << "behind whatever is there";
    EXPECT_FALSE(looks_at_the_same(view, KeyframeView{}, Pose::Identity()));
}

}  // namespace
}  // namespace planemap::places
