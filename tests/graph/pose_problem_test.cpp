// SPDX-License-Identifier: BSD-3-Clause
#include "graph/pose_problem.hpp"

#include <gtest/gtest.h>

namespace planemap::graph {
namespace {

Pose at_x(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

PoseEdge edge(int from, int to, double x, bool robust = false) {
    return {from, to, at_x(x), Matrix6d::Identity() / 0.01, robust};
}

OptimisationOptions with_kernel(double width) {
    OptimisationOptions options;
    options.kernel_width = width;
    return options;
}

/// Where the last of three nodes comes to lie that odometry has at 0, 1 and 2 m and a loop closure elsewhere.
double last_x(double loop_x, bool robust) {
    const std::vector<Pose> poses{at_x(0), at_x(1), at_x(2)};
    const std::vector<PoseEdge> edges{edge(0, 1, 1), edge(1, 2, 1), edge(0, 2, loop_x, robust)};
    PoseProblem problem(poses, nullptr, 1);
    problem.add(edges);
    problem.fix(0);
    EXPECT_TRUE(problem.solve(with_kernel(1)).IsSolutionUsable());
    EXPECT_TRUE(problem.pose(0).isApprox(poses[0])) << "it is fixed";
    return problem.pose(2).translation().x();
}

TEST(PoseProblem, EdgesShareTheirDisagreementByTheirWeights) {
    EXPECT_NEAR(last_x(2.0, false), 2.0, 1e-6);
    EXPECT_NEAR(last_x(2.03, false), 2.02, 1e-4) << "two edges of one weight against one";
}

TEST(PoseProblem, ARobustEdgeThatIsFarOffHardlyPulls) {
    EXPECT_LT(last_x(2.5, true), 2.02);
    EXPECT_GT(last_x(2.5, false), 2.3);
}

TEST(PoseProblem, ASightingDrawsItsNodeToThePlane) {
    Landmark floor;
    floor.plane = {Eigen::Vector3d::UnitZ(), 1};  // one metre below the first camera
    const std::vector<Landmark> landmarks{floor};
    std::vector<Sighting> sightings(2);
    for (int node = 0; node < 2; ++node) {
        Sighting& sighting = sightings[static_cast<std::size_t>(node)];
        sighting.node = node;
        sighting.landmark = 0;
        sighting.points_camera = {Eigen::Vector3d(1, 0, -1), Eigen::Vector3d(0, 1, -1),
                                  Eigen::Vector3d(-1, 0, -1), Eigen::Vector3d(0, -1, -1)};
        sighting.sqrt_weight = 1000;
    }
    std::vector<Pose> poses{at_x(0), at_x(1)};
    poses[1].translation().z() = 0.01;
    std::vector<PoseEdge> edges{{0, 1, poses[1], Matrix6d::Identity() / 0.1, false}};
    PoseProblem problem(poses, &landmarks, 1);
    problem.add(edges);
    problem.add(sightings);
    problem.fix(0);
    EXPECT_TRUE(problem.solve(with_kernel(1)).IsSolutionUsable());
    EXPECT_NEAR(problem.pose(1).translation().z(), 0, 1e-3);
    EXPECT_NEAR(problem.plane(0).d, 1, 1e-3);
    const std::vector<double*> moving{problem.node(1).change.data(), problem.plane_node(0).change.data()};
    EXPECT_EQ(problem.moving(), moving) << "nodes, then planes, and none that is fixed";
}

TEST(PoseProblem, ManyLoopClosuresAreSolvedToTheSamePoses) {
    constexpr int kNodes = 40;
    std::vector<Pose> truth, poses;
    std::vector<PoseEdge> edges;
    for (int i = 0; i < kNodes; ++i) {
        truth.push_back(at_x(0.1 * i));
        poses.push_back(at_x(0.1 * i + 0.001 * (i % 7)));
        if (i > 0) edges.push_back(edge(i - 1, i, 0.1));
        for (int j = 0; j + 1 < i; ++j)
            if ((i + j) % 2 == 0) edges.push_back(edge(j, i, 0.1 * (i - j), true));
    }
    poses[0] = truth[0];
    PoseProblem problem(poses, nullptr, 1);
    problem.add(edges);
    problem.fix(0);
    EXPECT_TRUE(problem.solve(with_kernel(1)).IsSolutionUsable());
    for (std::size_t i = 0; i < truth.size(); ++i)
        EXPECT_LT((problem.pose(i).translation() - truth[i].translation()).norm(), 1e-3) << i;
}

}  // namespace
}  // namespace planemap::graph
