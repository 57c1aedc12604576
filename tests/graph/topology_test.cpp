// SPDX-License-Identifier: BSD-3-Clause
#include "graph/topology.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random_values.hpp"

namespace planemap::graph {
namespace {

using test::Random;
using testing::ElementsAre;

constexpr double kStep = 0.1;  // metres and radians of drift a step

class TopologyTest : public testing::Test {
  protected:
    Tie tie(int from, int to, double drift = kStep) const {
        Tie tie;
        tie.edge = {from, to, poses_[at(from)].inverse(Eigen::Isometry) * poses_[at(to)],
                    100 * Matrix6d::Identity(), false};
        tie.drift = {drift, drift};
        return tie;
    }
    Tie step(int from, int to) const {
        Tie step = tie(from, to);
        step.is_step = true;
        return step;
    }
    /// A right loop closure that errs by so much along x.
    Tie loop(int from, int to, double error_m = 0, double drift = 0.01) const {
        Tie loop = tie(from, to, drift);
        loop.edge.from_from_to.translation().x() += error_m;
        loop.edge.robust = true;
        loop.is_known = loop.is_applied = false;
        return loop;
    }
    static Topology chain(const std::vector<Tie>& steps, int nodes) {
        Topology topology;
        for (int i = 0; i < nodes; ++i) topology.add_node();
        for (const Tie& step : steps) topology.add_odometry(step);
        return topology;
    }
    Topology chain(int nodes) const {
        std::vector<Tie> steps;
        for (int i = 1; i < nodes; ++i) steps.push_back(step(i - 1, i));
        return chain(steps, nodes);
    }

    Random random_{2};
    std::vector<Pose> poses_ = [this] {
        std::vector<Pose> poses;
        for (int i = 0; i < 10; ++i) {
            poses.push_back(random_.pose(0.2, 0.2));
            poses.back().translation().x() += i;
        }
        return poses;
    }();
};

TEST_F(TopologyTest, WithoutNodesThereIsNothing) {
    const Topology none;
    EXPECT_EQ(none.size(), 0);
    EXPECT_EQ(none.parts().size(), 0u);
    EXPECT_TRUE(none.edges(false).empty());
    EXPECT_FALSE(none.has_new_loops());
    EXPECT_EQ(none.worst_new_loop({}), 0);
}

TEST_F(TopologyTest, AGapTiesNoPartsAndIsAnEdgeOnlyWhileNothingElseIs) {
    Topology topology = chain({step(0, 1), step(2, 3)}, 4);
    topology.add_gap(tie(1, 2));
    UnionFind<int> parts = topology.parts();
    EXPECT_EQ(parts.find(1), 0);
    EXPECT_EQ(parts.find(3), 2);
    EXPECT_EQ(topology.edges(false).size(), 3u);
    topology.add_loop(loop(0, 3));
    EXPECT_EQ(topology.parts().find(3), 0);
    const std::vector<PoseEdge> edges = topology.edges(false);
    ASSERT_EQ(edges.size(), 3u) << "the loop closure stands for the gap";
    EXPECT_TRUE(edges.back().robust);
}

TEST_F(TopologyTest, ToStartWithNewLoopsAreBeyondDoubtAndDistrustedOnesLeftOut) {
    Topology topology = chain(6);
    topology.add_loop(loop(0, 4, 50));
    topology.mark_known();
    topology.weigh(1, poses_, 3.0);
    topology.add_loop(loop(0, 5));
    const std::vector<PoseEdge> start = topology.edges(true), all = topology.edges(false);
    ASSERT_EQ(start.size(), 6u);
    EXPECT_EQ(start.back().to, 5);
    EXPECT_FALSE(start.back().robust);
    ASSERT_EQ(all.size(), 7u);
    EXPECT_TRUE(all[5].robust && all[6].robust);
}

TEST_F(TopologyTest, DriftGrowsAlongTheChainAndALoopCutsItShortOnceThePosesFollow) {
    Topology topology = chain(6);
    const auto drift_of = [&](int node) { return topology.drifts_from(0)[at(node)].metres; };
    EXPECT_EQ(drift_of(0), 0);
    EXPECT_NEAR(drift_of(5), 5 * kStep, 1e-12);
    topology.add_loop(loop(0, 5));
    EXPECT_NEAR(drift_of(5), 5 * kStep, 1e-12) << "the poses do not follow it yet";
    topology.weigh(1, poses_, 3.0);
    EXPECT_NEAR(drift_of(5), 0.01, 1e-12);
    EXPECT_NEAR(drift_of(4), 0.01 + kStep, 1e-12);
}

TEST_F(TopologyTest, DriftIsUnboundedToWhatNothingTies) {
    const Topology topology = chain({step(0, 1)}, 3);
    EXPECT_TRUE(std::isinf(topology.drifts_from(0)[2].metres));
    EXPECT_FALSE(std::isinf(topology.drifts_from(0)[1].metres));
}

TEST_F(TopologyTest, ALoopThatTheKernelLetGoOfBoundsNoDrift) {
    Topology topology = chain(6);
    topology.add_loop(loop(0, 5, 50));
    topology.weigh(1, poses_, 3.0);
    EXPECT_LT(topology.loops()[0].weight, kDistrusted);
    EXPECT_NEAR(topology.drifts_from(0)[5].metres, 5 * kStep, 1e-12);
}

TEST_F(TopologyTest, WithinStepsCountsOdometryOnly) {
    Topology topology = chain(6);
    topology.add_loop(loop(0, 5));
    EXPECT_THAT(topology.within_steps(5, 3), ElementsAre(false, false, false, true, true, true));
    EXPECT_THAT(topology.within_steps(5, 1), ElementsAre(false, false, false, false, false, true));
    EXPECT_THAT(topology.within_steps(2, 100), ElementsAre(true, true, true, true, true, true));
}

TEST_F(TopologyTest, NewLoopsAreKnownOnceAnOptimisationIsAtWork) {
    Topology topology = chain(6);
    topology.add_loop(loop(0, 5, 0.5));
    EXPECT_TRUE(topology.has_new_loops());
    EXPECT_NEAR(topology.worst_new_loop(poses_), 50, 1e-6) << "half a metre of sigmas of 1 cm";
    ASSERT_EQ(topology.new_loops().size(), 1u);
    topology.mark_known();
    EXPECT_FALSE(topology.has_new_loops());
    EXPECT_TRUE(topology.new_loops().empty());
    EXPECT_EQ(topology.worst_new_loop(poses_), 0);
    EXPECT_TRUE(topology.has_unapplied_loop(5));
    EXPECT_FALSE(topology.has_unapplied_loop(3));
    topology.weigh(1, poses_, 3.0);
    EXPECT_FALSE(topology.has_unapplied_loop(5));
}

TEST_F(TopologyTest, ALoopThatCameMeanwhileIsWeighedButNotApplied) {
    Topology topology = chain(6);
    topology.add_loop(loop(0, 5));
    topology.add_loop(loop(0, 4, 50));
    topology.weigh(1, poses_, 3.0);
    EXPECT_TRUE(topology.loops()[0].is_applied);
    EXPECT_NEAR(topology.loops()[0].weight, 1, 1e-9);
    EXPECT_FALSE(topology.loops()[1].is_applied);
    EXPECT_LT(topology.loops()[1].weight, 0.01);
}

TEST_F(TopologyTest, TheNearestTrustedTieIsNeitherAGapNorADistrustedLoop) {
    std::vector<Pose> poses = poses_;
    poses[5] = poses[0] * pose_from_twist((Twist() << 0.01, 0, 0, 0, 0, 0).finished());
    Topology topology = chain({step(3, 4), step(4, 5)}, 6);
    topology.add_gap(tie(0, 5));
    EXPECT_FALSE(topology.nearest_trusted(0, poses));
    EXPECT_EQ(topology.nearest_trusted(5, poses)->other(5), 4);
    topology.add_loop(loop(0, 5));
    topology.weigh(1, poses, 3.0);  // these contradict it
    EXPECT_EQ(topology.nearest_trusted(5, poses)->other(5), 4);
    Topology trusting = chain({step(3, 4), step(4, 5)}, 6);
    trusting.add_loop(loop(0, 5));
    EXPECT_EQ(trusting.nearest_trusted(5, poses)->other(5), 0);
}

TEST_F(TopologyTest, ANodeThatGoesLeavesItsTiesToItsKeeper) {
    Topology topology = chain(5);
    topology.add_loop(loop(2, 4));
    topology.mark_known();
    topology.weigh(1, poses_, 3.0);
    topology.hand_over(step(1, 2), 2, poses_);
    EXPECT_EQ(topology.size(), 4);
    EXPECT_EQ(topology.parts().find(3), 0);
    ASSERT_EQ(topology.loops().size(), 1u);
    EXPECT_TRUE(topology.loops()[0].touches(1));
    EXPECT_TRUE(topology.loops()[0].touches(3)) << "node 4, now that 2 is gone";
    const double drift = topology.drifts_from(0)[3].metres;
    EXPECT_NEAR(drift, kStep + 0.01 + kStep, 1e-12) << "to 1, by the loop closure and its detour";
}

}  // namespace
}  // namespace planemap::graph
