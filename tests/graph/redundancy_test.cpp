// SPDX-License-Identifier: BSD-3-Clause
#include "graph/redundancy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph/graph_parts.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;
using testing::ElementsAre;
using testing::IsEmpty;

class RedundancyTest : public testing::Test {
  protected:
    /// A camera that stands still for so many keyframes, without drift.
    Walk standing(int count) {
        Walk walk =
            test::walk(room_, std::vector<Pose>(static_cast<std::size_t>(count), looking({0, 0, 0}, 0)),
                       random_, {Twist::Zero(), 0, 0});
        for (Keyframe& keyframe : walk.keyframes) keyframe.covariance.setZero();
        return walk;
    }
    Random random_{1};
    std::vector<test::Landmark> room_ = make_room(random_, Eigen::Vector3d::Zero(), 3.5, 3000);
};

TEST_F(RedundancyTest, AsksOfEachKeyframeOnceWhenItIsNoLongerAmongTheNewest) {
    GraphParts parts;
    Redundancy redundancy{GraphOptions{}};
    EXPECT_FALSE(redundancy.next(parts.keyframes)) << "of none";
    const Walk walk = standing(26);
    for (int i = 0; i < 24; ++i) parts.add(walk.keyframes[at(i)], walk.world_from_camera[at(i)]);
    EXPECT_FALSE(redundancy.next(parts.keyframes));
    for (int i = 24; i < 26; ++i) parts.add(walk.keyframes[at(i)], walk.world_from_camera[at(i)]);
    for (const int expected : {0, 1}) {
        const std::optional<int> next = redundancy.next(parts.keyframes);
        ASSERT_TRUE(next);
        EXPECT_EQ(*next, expected);
        EXPECT_THAT(redundancy.about(*next, parts.keyframes, parts.topology), IsEmpty());
    }
    EXPECT_FALSE(redundancy.next(parts.keyframes));
}

TEST_F(RedundancyTest, TheOlderOfThoseThatLookAlikeGoes) {
    const GraphParts parts = parts_of(standing(4));
    Redundancy redundancy{GraphOptions{}};
    EXPECT_THAT(redundancy.about(0, parts.keyframes, parts.topology), IsEmpty());
    EXPECT_THAT(redundancy.about(1, parts.keyframes, parts.topology), IsEmpty()) << "one newer is alike";
    EXPECT_THAT(redundancy.about(2, parts.keyframes, parts.topology), ElementsAre(0)) << "two newer are";
    EXPECT_THAT(redundancy.about(3, parts.keyframes, parts.topology), ElementsAre(1, 0));
}

TEST_F(RedundancyTest, WhoWentNoLongerCountsAsAlike) {
    GraphParts parts = parts_of(standing(4));
    Redundancy redundancy{GraphOptions{}};
    for (int node = 0; node < 2; ++node) redundancy.about(node, parts.keyframes, parts.topology);
    parts.topology.hand_over(*parts.topology.nearest_trusted(1, parts.keyframes.poses()), 1,
                             parts.keyframes.poses());
    parts.keyframes.remove(1, 0);
    redundancy.forget(1);
    EXPECT_THAT(redundancy.about(1, parts.keyframes, parts.topology), IsEmpty())
        << "1, which looked like 0, has gone: only 2 does";
    EXPECT_THAT(redundancy.about(2, parts.keyframes, parts.topology), ElementsAre(0));
}

TEST_F(RedundancyTest, OtherViewsAndOtherPlacesStay) {
    const GraphParts parts = parts_of(test::walk(room_, square_loop(3, 8, 1.0), random_));
    Redundancy redundancy{GraphOptions{}};
    for (int node = 0; node < parts.keyframes.size(); ++node)
        EXPECT_THAT(redundancy.about(node, parts.keyframes, parts.topology), IsEmpty()) << node;
}

TEST_F(RedundancyTest, BeyondTheMostOfAPlaceTheOldestGo) {
    Walk walk = standing(7);
    for (Keyframe& keyframe : walk.keyframes) {
        for (Feature& feature : keyframe.features) feature.descriptor = random_descriptor(random_);
    }
    const GraphParts parts = parts_of(walk);
    GraphOptions options;
    options.max_place = 5;
    Redundancy redundancy(options);
    EXPECT_THAT(redundancy.about(4, parts.keyframes, parts.topology), IsEmpty());
    EXPECT_THAT(redundancy.about(6, parts.keyframes, parts.topology), ElementsAre(0, 1));
}

TEST_F(RedundancyTest, WhenAllAreToStayNobodyIsAsked) {
    GraphOptions options;
    options.max_alike = 0;
    EXPECT_FALSE(Redundancy(options).next(parts_of(standing(40)).keyframes));
}

TEST_F(RedundancyTest, ViewsOfNothingAreOfNoPlace) {
    GraphParts parts;
    for (int id = 0; id < 3; ++id) {
        Keyframe empty;
        empty.id = id;
        empty.covariance.setZero();
        parts.add(empty, Pose::Identity());
    }
    Redundancy redundancy{GraphOptions{}};
    for (int node = 0; node < 3; ++node)
        EXPECT_THAT(redundancy.about(node, parts.keyframes, parts.topology), IsEmpty());
}

}  // namespace
}  // namespace planemap::graph
