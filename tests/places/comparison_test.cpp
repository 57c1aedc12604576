// SPDX-License-Identifier: BSD-3-Clause
#include "places/comparison.hpp"

#include <gtest/gtest.h>

#include <set>

#include "places/synthetic.hpp"

namespace planemap::places {
namespace {

using namespace planemap::test;

class ComparisonTest : public testing::Test {
  protected:
    KeyframeView view_at(const Pose& pose) {
        Keyframe keyframe;
        keyframe.features = see(room_, pose, random_);
        return make_view(keyframe, 1000);
    }

    Random random_{1};
    std::vector<test::Landmark> room_ = make_room(random_, Eigen::Vector3d::Zero(), 2.5, 1500);
    Pose here_ = looking(Eigen::Vector3d(0.1, 0, -0.3), 0);
    Pose there_ = looking(Eigen::Vector3d(0.4, 0.1, 0.0), 0.25);
};

TEST_F(ComparisonTest, PlaneAgreementCountsSamples) {
    KeyframeView a = view_at(here_), b = a;
    EXPECT_EQ(compare_planes(a, b, Pose::Identity()).agree, 0);
    a.regions = {wall(2.7)};
    b.regions = {wall(2.72)};
    const PlaneAgreement same = compare_planes(a, b, Pose::Identity());
    EXPECT_GT(same.agree, 20);
    EXPECT_EQ(same.contradict, 0);
    b.regions = {wall(1.0, 0.3)};
    const PlaneAgreement before = compare_planes(a, b, Pose::Identity());
    EXPECT_EQ(before.agree, 0);
    EXPECT_GT(before.contradict, 20);
    EXPECT_EQ(compare_planes(a, b, looking(Eigen::Vector3d::Zero(), M_PI)).contradict, 0) << "out of view";
}

TEST_F(ComparisonTest, PlanesAreComparedBothWaysAlike) {
    KeyframeView a = view_at(here_), b = view_at(there_);
    a.regions = {wall(2.7), wall(1.1, 0.2)};
    b.regions = {wall(2.4)};
    const Pose a_from_b = here_.inverse() * there_;
    const PlaneAgreement one = compare_planes(a, b, a_from_b),
                         other = compare_planes(b, a, a_from_b.inverse());
    EXPECT_EQ(one.agree, other.agree);
    EXPECT_EQ(one.contradict, other.contradict);
}

TEST_F(ComparisonTest, PointsAgreeAtTheTruePoseAndWithinSlack) {
    const KeyframeView a = view_at(here_), b = view_at(there_);
    const Pose truth = here_.inverse() * there_;
    const PointAgreement right = compare_points(a, b, truth, {}, 0);
    EXPECT_GT(right.visible, 60);
    EXPECT_GT(right.agree, 0.6 * right.visible);
    Pose off = truth;
    off.translation().x() += 0.3;
    EXPECT_LT(compare_points(a, b, off, {}, 0).agree, 0.1 * right.agree);
    EXPECT_GT(compare_points(a, b, off, {}, 0.3).agree, 0.6 * right.agree);
}

TEST_F(ComparisonTest, APointTakesPartOnce) {
    const KeyframeView a = view_at(here_), b = view_at(there_);
    const std::vector<Match> matches = match_at(a, b, here_.inverse() * there_, {}, 0.1);
    std::set<int> first, second;
    for (const Match& match : matches) {
        EXPECT_TRUE(first.insert(match.first).second);
        EXPECT_TRUE(second.insert(match.second).second);
    }
    EXPECT_GT(matches.size(), 60u);
}

TEST_F(ComparisonTest, EmptyViewsAgreeOnNothing) {
    const KeyframeView a = view_at(here_), none;
    for (const auto& [one, other] : {std::pair(&a, &none), std::pair(&none, &a), std::pair(&none, &none)}) {
        EXPECT_TRUE(match_at(*one, *other, Pose::Identity(), {}).empty());
        EXPECT_EQ(compare_points(*one, *other, Pose::Identity(), {}, 1).agree, 0);
        EXPECT_EQ(compare_planes(*one, *other, Pose::Identity()).agree, 0);
    }
}

TEST_F(ComparisonTest, WhatOthersSawThroughSpeaksAgainstAView) {
    KeyframeView view = view_at(here_), beside = view, through = view;
    view.regions = {wall(1.5)};
    beside.regions = {wall(1.51)};
    through.regions = {wall(2.7)};
    const PlacedView sees_it{&beside, Pose::Identity()}, sees_past{&through, Pose::Identity()};
    const PlacedView elsewhere{&through, looking(Eigen::Vector3d::Zero(), M_PI)};
    const auto share = [&](std::vector<PlacedView> others) { return share_seen_through(view, others, 0.05); };
    EXPECT_EQ(share({}), 0);
    EXPECT_EQ(share({sees_it}), 0);
    EXPECT_EQ(share({elsewhere}), 0);
    EXPECT_EQ(share({sees_past}), 1);
    EXPECT_EQ(share({sees_past, sees_it}), 0) << "it is there for one of them";
    EXPECT_EQ(share_seen_through(through, std::vector{PlacedView{&view, Pose::Identity()}}, 0.05), 1)
        << "the view looks through what another one saw";
    EXPECT_EQ(share_seen_through(through, std::vector{PlacedView{&view, Pose::Identity()}}, 2), 0);
}

}  // namespace
}  // namespace planemap::places
