// SPDX-License-Identifier: BSD-3-Clause
#include "graph/optimisation_task.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace planemap::graph {
namespace {

Pose at_x(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

PoseEdge edge(int from, int to, double x, double sigma_m, bool robust = false) {
    return {from, to, at_x(x), Matrix6d::Identity() / sigma_m, robust};
}

/// Ten steps of a metre along x, each of which odometry took for 1.05 m, and what a loop closure says of the
/// last node: exact to a centimetre.
OptimisationTask task(double loop_says_x) {
    OptimisationTask task;
    for (int i = 0; i <= 10; ++i) task.poses.push_back(at_x(1.05 * i));
    for (int i = 1; i <= 10; ++i) task.edges.push_back(edge(i - 1, i, 1.05, 0.05));
    task.trusting_edges = task.edges;
    task.edges.push_back(edge(0, 10, loop_says_x, 0.01, true));
    task.trusting_edges.push_back(edge(0, 10, loop_says_x, 0.01, false));
    task.new_loops = {task.edges.back()};
    task.options = {3.0, 50};
    return task;
}

double last_x(const OptimisationTask& task) {
    return task.poses.back().translation().x();
}

TEST(OptimisationTaskTest, ALoopFarFromThePosesPullsAgainstTheKernelWhenTheRestAgrees) {
    OptimisationTask trusting = task(10);
    trusting.run();
    EXPECT_FALSE(trusting.failed);
    EXPECT_NEAR(last_x(trusting), 10, 0.05);
    EXPECT_EQ(trusting.poses[0].matrix(), at_x(0).matrix());
}

TEST(OptimisationTaskTest, WhatTheRestContradictsIsLetGo) {
    OptimisationTask contradicted = task(0);
    // Other loops, known for long, say where the last node is.
    for (int i = 0; i < 10; ++i) {
        contradicted.edges.push_back(edge(0, 10, 10.5, 0.01, true));
        contradicted.trusting_edges.push_back(contradicted.edges.back());
    }
    contradicted.run();
    EXPECT_FALSE(contradicted.failed);
    EXPECT_NEAR(last_x(contradicted), 10.5, 0.05);
}

TEST(OptimisationTaskTest, TheSameTaskGivesTheSameBytes) {
    OptimisationTask one = task(10), two = task(10);
    one.run();
    two.run();
    for (std::size_t i = 0; i < one.poses.size(); ++i)
        EXPECT_EQ(one.poses[i].matrix(), two.poses[i].matrix());
}

TEST(OptimisationTaskTest, WhenTheSolverGivesUpItSaysSoAndThePosesStay) {
    OptimisationTask bad = task(10);
    bad.trusting_edges.clear();
    bad.edges[3].sqrt_information(0, 0) = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Pose> before = bad.poses;
    bad.run();
    EXPECT_TRUE(bad.failed);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(bad.poses[i].matrix(), before[i].matrix());
}

TEST(OptimisationTaskTest, WithoutEdgesThereIsNothingToDo) {
    OptimisationTask empty;
    empty.run();
    EXPECT_FALSE(empty.failed);
    OptimisationTask one;
    one.poses = {at_x(3)};
    one.run();
    EXPECT_EQ(one.poses[0].matrix(), at_x(3).matrix());
}

}  // namespace
}  // namespace planemap::graph
