// SPDX-License-Identifier: BSD-3-Clause
#include "graph/loop_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph/graph_parts.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;
using testing::Contains;
using testing::Each;
using testing::Ge;
using testing::IsEmpty;
using testing::Lt;
using testing::Not;

class LoopSearchTest : public testing::Test {
  protected:
    LoopSearch search_for(const GraphParts& parts, const GraphOptions& options = {}) const {
        LoopSearch search(options);
        for (int node = 0; node < parts.keyframes.size(); ++node) search.add(parts.keyframes[node].view);
        return search;
    }
    static std::vector<Drift> drifts(const GraphParts& parts) {
        return parts.topology.drifts_from(parts.keyframes.newest());
    }
    static std::vector<int> candidates(const LoopSearch& search, const GraphParts& parts) {
        return search.candidates(parts.keyframes, parts.topology, drifts(parts));
    }

    Random random_{1};
    std::vector<test::Landmark> room_ = make_room(random_, Eigen::Vector3d::Zero(), 3.5, 3000);
    std::vector<Pose> poses_ = square_loop(3, 10, 1.0);  // ends where it starts
    GraphParts round_ = parts_of(test::walk(room_, poses_, random_));
};

TEST_F(LoopSearchTest, BackAtTheStartItFindsTheFirstByTheirLooks) {
    GraphOptions options;
    options.place_candidates = 0;
    const std::vector<int> found = candidates(search_for(round_, options), round_);
    EXPECT_THAT(found, Contains(Lt(3)));
    EXPECT_LE(found.size(), 3u);
}

TEST_F(LoopSearchTest, OrByWhereTheyStandWhileDriftIsSmall) {
    GraphOptions options;
    options.appearance_candidates = 0;
    options.max_place_drift_m = 100;
    EXPECT_THAT(candidates(search_for(round_, options), round_), Contains(Lt(3)));
    options.max_place_drift_m = 0;
    EXPECT_THAT(candidates(search_for(round_, options), round_), IsEmpty());
}

TEST_F(LoopSearchTest, NeighboursAlongTheChainAreNoCandidates) {
    GraphOptions options;
    const int newest = round_.keyframes.newest();
    EXPECT_THAT(candidates(search_for(round_, options), round_), Not(Contains(Ge(newest - 7))));
    options.min_separation = 1000;
    EXPECT_THAT(candidates(search_for(round_, options), round_), IsEmpty());
}

TEST_F(LoopSearchTest, TheVerifiedPoseIsTheTrueOne) {
    const LoopSearch search = search_for(round_);
    const auto found = search.verified(0, round_.keyframes, round_.topology, drifts(round_));
    ASSERT_TRUE(found);
    const Pose truth = poses_.front().inverse() * poses_.back();
    EXPECT_LT(twist_from_pose(truth.inverse() * found->a_from_b).norm(), 0.06);
}

TEST_F(LoopSearchTest, OtherPlacesAreNotVerified) {
    const LoopSearch search = search_for(round_);
    for (const int node : {10, 20, 30})
        EXPECT_FALSE(search.verified(node, round_.keyframes, round_.topology, drifts(round_))) << node;
}

/// A round in a room, then one in its twin 8 m beside, if asked for, and back to where it began.
GraphParts tour(const std::vector<test::Landmark>& room, bool with_twin, Random& random) {
    const Eigen::Vector3d beside(8, 0, 0);
    std::vector<test::Landmark> landmarks = room;
    if (with_twin)
        for (const test::Landmark& landmark : room)
            landmarks.push_back({landmark.position + beside, landmark.descriptor});
    std::vector<Pose> poses = square_loop(3, 4, 1.0);
    const std::vector<Pose> twin = square_loop(3, 4, 1.0, beside);
    poses.insert(poses.end(), twin.begin(), twin.end());
    poses.push_back(poses.front());
    return parts_of(test::walk(landmarks, poses, random));
}

TEST_F(LoopSearchTest, WhereOdometryDoesNotKnowAnythingATwinRefutes) {
    const std::vector<test::Landmark> room = make_room(random_, Eigen::Vector3d::Zero(), 2.5, 1500);
    for (const bool with_twin : {false, true}) {
        const GraphParts parts = tour(room, with_twin, random_);
        const LoopSearch search = search_for(parts);
        const std::vector<Drift> anywhere(static_cast<std::size_t>(parts.keyframes.size()), Drift{1000, 10});
        EXPECT_NE(search.verified(0, parts.keyframes, parts.topology, anywhere).has_value(), with_twin);
        const std::vector<Drift> here(static_cast<std::size_t>(parts.keyframes.size()), Drift{0.1, 0.1});
        EXPECT_TRUE(search.verified(0, parts.keyframes, parts.topology, here)) << "it cannot be in the other";
    }
}

TEST_F(LoopSearchTest, WhatOdometryRulesOutIsNotVerified) {
    Pose aside = Pose::Identity();
    aside.translation().x() = 3;
    std::vector<bool> newest(poses_.size(), false);
    newest.back() = true;
    round_.keyframes.carry(newest, aside);
    const std::vector<Drift> none(poses_.size(), Drift{0, 0});
    EXPECT_FALSE(search_for(round_).verified(0, round_.keyframes, round_.topology, none));
    GraphOptions loose;
    loose.drift_base_m = 10;
    loose.surroundings_from_m = 10;
    EXPECT_TRUE(search_for(round_, loose).verified(0, round_.keyframes, round_.topology, none));
}

TEST_F(LoopSearchTest, OneThatWentIsNotFoundAndTheOthersAreByTheirNewNumbers) {
    GraphOptions options;
    options.place_candidates = 0;
    LoopSearch search = search_for(round_, options);
    for (int gone = 0; gone < 5; ++gone) {
        const std::optional<Tie> tie = round_.topology.nearest_trusted(1, round_.keyframes.poses());
        ASSERT_TRUE(tie);
        search.remove(1, round_.keyframes[1].view);
        round_.topology.hand_over(*tie, 1, round_.keyframes.poses());
        round_.keyframes.remove(1, tie->other(1));
    }
    const std::vector<int> found = candidates(search, round_);
    EXPECT_THAT(found, Contains(0));
    EXPECT_THAT(found, Each(Lt(round_.keyframes.size())));
    EXPECT_TRUE(search.verified(0, round_.keyframes, round_.topology, drifts(round_)));
}

TEST_F(LoopSearchTest, ViewsOfNothingAreNoCandidates) {
    GraphParts parts;
    for (int id = 0; id < 12; ++id) {
        Keyframe empty;
        empty.id = id;
        parts.add(empty, Pose::Identity());
    }
    const LoopSearch search = search_for(parts);
    EXPECT_THAT(candidates(search, parts), IsEmpty());
    EXPECT_FALSE(search.verified(0, parts.keyframes, parts.topology, drifts(parts)));
}

}  // namespace
}  // namespace planemap::graph
