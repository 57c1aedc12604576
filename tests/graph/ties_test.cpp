// SPDX-License-Identifier: BSD-3-Clause
#include "graph/ties.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/random_values.hpp"

namespace planemap::graph {
namespace {

using test::Random;

Pose random_pose(Random& random, double metres, double radians) {
    Twist twist;
    twist << random.vector(metres), random.vector(radians);
    return pose_from_twist(twist);
}

/// A tie between two nodes that errs, with a covariance that is no multiple of the identity.
Tie noisy_tie(Random& random, const std::vector<Pose>& truth, int from, int to) {
    Matrix6d root = 0.01 * Matrix6d::Identity();
    for (int i = 0; i < 36; ++i) root(i / 6, i % 6) += random.uniform(-0.003, 0.003);
    Tie tie;
    tie.edge.from = from;
    tie.edge.to = to;
    tie.edge.from_from_to = truth[static_cast<std::size_t>(from)].inverse() *
                            truth[static_cast<std::size_t>(to)] * random_pose(random, 0.01, 0.01);
    tie.edge.sqrt_information = sqrt_information(root * root.transpose(), 0, 0);
    tie.drift = {0.1, 0.1};
    return tie;
}

std::vector<PoseEdge> edges_of(const std::vector<Tie>& ties) {
    std::vector<PoseEdge> edges;
    for (const Tie& tie : ties) edges.push_back(tie.edge);
    return edges;
}

double distance_between(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm() + rotation_angle(a.inverse() * b);
}

class TiesTest : public testing::Test {
  protected:
    void SetUp() override {
        for (int i = 0; i < 6; ++i) truth_.push_back(random_pose(random_, 2, 1));
    }
    /// The optimum of all ties, from the truth.
    std::vector<Pose> optimum(const std::vector<Tie>& ties, const std::vector<Pose>& start) const {
        std::vector<Pose> poses = start;
        optimise(poses, edges_of(ties), 0, {0, 100});
        return poses;
    }
    Random random_{3};
    std::vector<Pose> truth_;
};

TEST_F(TiesTest, WhereACovarianceIsNotUsableATieIsSoft) {
    const GraphOptions options;
    const Matrix6d unknown = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
    const Tie odometry = odometry_tie(options, 0, 1, truth_[1], unknown);
    const Tie loop = loop_tie(options, 0, 1, truth_[1], unknown, 3);
    for (const Tie& tie : {odometry, loop}) {
        EXPECT_TRUE(tie.edge.sqrt_information.allFinite());
        EXPECT_LT(tie.edge.sqrt_information.norm(), 20);
        EXPECT_TRUE(std::isfinite(tie.drift.size()));
    }
    EXPECT_TRUE(odometry.is_step && odometry.is_known && odometry.is_applied);
    EXPECT_FALSE(odometry.edge.robust);
    EXPECT_TRUE(loop.edge.robust);
    EXPECT_FALSE(loop.is_step || loop.is_known || loop.is_applied);
    EXPECT_EQ(loop.closure, 3);
}

TEST_F(TiesTest, AStepIsNoLessCertainThanACamerasSpeedLetsItBe) {
    Matrix6d covariance = 1e-6 * Matrix6d::Identity();
    covariance(1, 1) = 100;  // nothing was seen of that direction, nor of a turn that goes with it
    covariance(5, 5) = 25;
    covariance(1, 5) = covariance(5, 1) = 49;
    const Matrix6d known = within_reach(covariance, 0.1);
    EXPECT_NEAR(known(0, 0), 1e-6, 1e-9);
    EXPECT_NEAR(known(4, 4), 1e-6, 1e-9);
    EXPECT_LT(known(1, 1) + known(5, 5), 2 * 0.1 * 0.1);
    EXPECT_GT(known(1, 1) + known(5, 5), 0.5 * 0.1 * 0.1);
    EXPECT_GT(Eigen::LLT<Matrix6d>(known).matrixL().toDenseMatrix().diagonal().minCoeff(), 0);
    for (const double wide : {1e6, 1e20, 1e100})
        EXPECT_NEAR(within_reach(wide * Matrix6d::Identity(), 0.1)(2, 2), 0.1 * 0.1, 1e-6) << wide;
    EXPECT_EQ(within_reach(covariance, 0), covariance);
    EXPECT_EQ(within_reach(covariance, -5), covariance);
    const Matrix6d unknown = Matrix6d::Constant(std::numeric_limits<double>::infinity());
    EXPECT_EQ(within_reach(unknown, 0.1), unknown);
}

TEST_F(TiesTest, ADetourMakesAStepSofterAndItsDriftLarger) {
    const GraphOptions options;
    const Matrix6d covariance = 1e-6 * Matrix6d::Identity();
    const Tie plain = odometry_tie(options, 0, 1, truth_[1], covariance);
    const Tie detour = odometry_tie(options, 0, 1, truth_[1], covariance, {0.1, 0.2});
    EXPECT_LT(detour.edge.sqrt_information.norm(), plain.edge.sqrt_information.norm());
    EXPECT_NEAR(detour.drift.metres, plain.drift.metres + 0.1, 1e-12);
    EXPECT_NEAR(detour.drift.radians, plain.drift.radians + 0.2, 1e-12);
}

TEST_F(TiesTest, AGapIsAsWideAsTheCameraMayHaveGone) {
    GraphOptions options;
    options.max_lost_speed = 2;
    EXPECT_EQ(gap_tie(options, 0, 1, truth_[1], 0).drift.metres, 0);
    EXPECT_EQ(gap_tie(options, 0, 1, truth_[1], 10).drift.metres, 20);
    EXPECT_LT(gap_tie(options, 0, 1, truth_[1], 10).edge.sqrt_information(0, 0), 0.06);
}

TEST_F(TiesTest, AnEdgeReadFromItsOtherEndWeighsTheSame) {
    for (int i = 0; i < 20; ++i) {
        const Tie tie = noisy_tie(random_, truth_, 1, 4);
        const double there = edge_error(tie.edge, truth_[1], truth_[4]).norm();
        const PoseEdge back = reversed(tie.edge);
        EXPECT_EQ(back.from, 4);
        EXPECT_NEAR(edge_error(back, truth_[4], truth_[1]).norm(), there, 0.03 * there);
        EXPECT_NEAR(distance_between(reversed(back).from_from_to, tie.edge.from_from_to), 0, 1e-9);
    }
}

TEST_F(TiesTest, OfAChainNothingIsLost) {
    // 0 - 1 - 2, and a second tie between 0 and 2 that contradicts it: the middle node goes, 0 and 2 stay.
    std::vector<Tie> ties{noisy_tie(random_, truth_, 0, 1), noisy_tie(random_, truth_, 2, 1),
                          noisy_tie(random_, truth_, 0, 2)};
    const std::vector<Pose> before = optimum(ties, truth_);
    const Tie handed = handed_over(ties[1], ties[0], 1, before);
    EXPECT_EQ(handed.edge.from, 0);
    EXPECT_EQ(handed.edge.to, 2);
    const std::vector<Pose> after = optimum({handed, ties[2]}, before);
    EXPECT_LT(distance_between(after[2], before[2]), 1e-4);
    // From another start, too: the marginal pulls as the chain did.
    std::vector<Pose> elsewhere = before;
    elsewhere[2] = elsewhere[2] * random_pose(random_, 0.02, 0.02);
    EXPECT_LT(distance_between(optimum({handed, ties[2]}, elsewhere)[2], before[2]), 1e-4);
    // And it is as uncertain: the sum of both, seen from 2.
    const Matrix6d covariance =
        (handed.edge.sqrt_information.transpose() * handed.edge.sqrt_information).inverse();
    EXPECT_GT(
        covariance.trace(),
        1.5 * (ties[0].edge.sqrt_information.transpose() * ties[0].edge.sqrt_information).inverse().trace());
}

TEST_F(TiesTest, ANodeThatGoesLeavesTheOptimumWhereItIs) {
    // Everything is tied to everything, and every tie errs.
    std::vector<Tie> ties;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < i; ++j) ties.push_back(noisy_tie(random_, truth_, i % 2 ? i : j, i % 2 ? j : i));
    }
    const std::vector<Pose> before = optimum(ties, truth_);
    const Tie to_keeper = *std::find_if(ties.begin(), ties.end(),
                                        [](const Tie& tie) { return tie.touches(2) && tie.touches(4); });
    hand_over(ties, to_keeper, 2, before);
    EXPECT_EQ(ties.size(), 10u) << "five nodes, each pair tied once";
    std::vector<Pose> left = before;
    left.erase(left.begin() + 2);
    for (const Tie& tie : ties) EXPECT_TRUE(tie.edge.from < 5 && tie.edge.to < 5);
    const std::vector<Pose> after = optimum(ties, left);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_LT(distance_between(after[i], left[i]), 1e-3);
}

TEST_F(TiesTest, TwoMeasurementsCountAsBothAndManyAsFour) {
    Tie tie = noisy_tie(random_, truth_, 0, 1), other = noisy_tie(random_, truth_, 1, 0);
    const std::vector<Pose> both = optimum({tie, other}, truth_);
    const double alone = tie.edge.sqrt_information.norm();
    fuse(tie, other, truth_);
    EXPECT_LT(distance_between(optimum({tie}, truth_)[1], both[1]), 5e-4);
    EXPECT_EQ(tie.measurements, 2);
    for (int i = 0; i < 100; ++i) fuse(tie, noisy_tie(random_, truth_, 0, 1), truth_);
    EXPECT_EQ(tie.measurements, 4);
    EXPECT_LT(tie.edge.sqrt_information.norm(), 3 * alone) << "about twice, not ten times";
    EXPECT_LT(distance_between(tie.edge.from_from_to, truth_[0].inverse() * truth_[1]), 0.02);
}

TEST_F(TiesTest, ClosuresThatNobodyBelievesEnd) {
    std::vector<Tie> loops{noisy_tie(random_, truth_, 1, 2), noisy_tie(random_, truth_, 1, 3)};
    for (Tie& tie : loops) tie.edge.robust = true;
    loops[1].weight = 0.01;
    hand_over(loops, noisy_tie(random_, truth_, 0, 1), 1, truth_);
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_EQ(loops[0].edge.from, 0);
    EXPECT_EQ(loops[0].edge.to, 1) << "node 2, now that 1 is gone";
}

}  // namespace
}  // namespace planemap::graph
