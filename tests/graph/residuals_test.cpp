// SPDX-License-Identifier: BSD-3-Clause
#include "graph/residuals.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap::graph {
namespace {

std::mt19937_64 random_bits(5);

Twist some_twist(double scale) {
    std::normal_distribution<double> normal(0, scale);
    Twist twist;
    for (int i = 0; i < 6; ++i) twist[i] = normal(random_bits);
    return twist;
}

Node some_node() {
    Node node(pose_from_twist(some_twist(0.5)));
    const Twist change = some_twist(0.1);
    std::copy(change.data(), change.data() + 6, node.change.begin());
    node.update();
    return node;
}

PlaneNode some_plane() {
    Landmark landmark;
    landmark.plane = {Eigen::Vector3d(0.3, -0.2, 1).normalized(), -1.5};
    landmark.box.frame_from_box.translation() = Eigen::Vector3d(0.4, 0.2, 1.2);
    PlaneNode plane(landmark);
    plane.change = {0.05, -0.03, 0.02};
    return plane;
}

Sighting some_sighting() {
    Sighting sighting;
    const Eigen::Vector3d centre(0.3, 0.2, 2), u(0.5, 0.1, 0.1), v(-0.1, 0.4, 0.05);
    sighting.points_camera = {centre + u, centre + v, centre - u, centre - v};
    sighting.sqrt_weight = 40;
    return sighting;
}

/// Derivatives of `residuals` by `change` as they are measured, by moving it a little either way.
template <int kRows, std::size_t kColumns, typename Evaluate>
Eigen::Matrix<double, kRows, static_cast<int>(kColumns)> measured(std::array<double, kColumns>& change,
                                                                  const Evaluate& evaluate) {
    constexpr double kStep = 1e-6;
    Eigen::Matrix<double, kRows, static_cast<int>(kColumns)> jacobian;
    for (std::size_t i = 0; i < kColumns; ++i) {
        const double before = change[i];
        change[i] = before + kStep;
        const Eigen::Matrix<double, kRows, 1> above = evaluate();
        change[i] = before - kStep;
        const Eigen::Matrix<double, kRows, 1> below = evaluate();
        change[i] = before;
        jacobian.col(static_cast<Eigen::Index>(i)) = (above - below) / (2 * kStep);
    }
    evaluate();
    return jacobian;
}

TEST(Residuals, ANodeThatHasNotMovedIsWhereItStarted) {
    const Pose pose = pose_from_twist(some_twist(0.5));
    EXPECT_TRUE(Node(pose).pose().isApprox(pose));
}

TEST(Residuals, AnEdgeThatFitsHasNoError) {
    Node from = some_node(), to = some_node();
    PoseEdge edge;
    edge.from_from_to = from.pose().inverse() * to.pose();
    Twist residuals;
    EXPECT_TRUE(EdgeCost(edge, from, to).Evaluate(nullptr, residuals.data(), nullptr));
    EXPECT_LT(residuals.norm(), 1e-12);
}

TEST(Residuals, AnEdgesErrorIsWhitened) {
    Node from = some_node(), to = some_node();
    PoseEdge edge;
    edge.from_from_to = from.pose().inverse() * to.pose() * pose_from_twist(some_twist(0.05));
    Twist once, twice;
    EdgeCost(edge, from, to).Evaluate(nullptr, once.data(), nullptr);
    EXPECT_TRUE(once.isApprox(edge_error(edge, from.pose(), to.pose()), 1e-9));
    edge.sqrt_information *= 2;
    EdgeCost(edge, from, to).Evaluate(nullptr, twice.data(), nullptr);
    EXPECT_TRUE(twice.isApprox(2 * once));
}

TEST(Residuals, AnEdgesDerivativesAreThoseOfItsError) {
    for (int i = 0; i < 5; ++i) {
        Node from = some_node(), to = some_node();
        PoseEdge edge;
        edge.from_from_to = from.pose().inverse() * to.pose() * pose_from_twist(some_twist(0.1));
        edge.sqrt_information.diagonal() << 1, 2, 3, 4, 5, 6;
        const EdgeCost cost(edge, from, to);
        using Jacobian = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
        Jacobian by_from, by_to;
        double* jacobians[] = {by_from.data(), by_to.data()};
        Twist residuals;
        cost.Evaluate(nullptr, residuals.data(), jacobians);
        const auto evaluate = [&] {
            from.update();
            to.update();
            Twist moved;
            cost.Evaluate(nullptr, moved.data(), nullptr);
            return moved;
        };
        EXPECT_LT((measured<6>(from.change, evaluate) - by_from).norm(), 1e-6);
        EXPECT_LT((measured<6>(to.change, evaluate) - by_to).norm(), 1e-6);
    }
}

TEST(Residuals, ASightingsTermsAddUpToTheDistancesOfItsPoints) {
    const Node node = some_node();
    const PlaneNode plane = some_plane();
    const Sighting sighting = some_sighting();
    Eigen::Vector3d residuals;
    SightingCost(sighting, node, plane).Evaluate(nullptr, residuals.data(), nullptr);
    EXPECT_NEAR(residuals.squaredNorm(), sighting_error(sighting, node.pose(), plane.plane()).squaredNorm(),
                1e-6);
}

TEST(Residuals, ASightingsDerivativesAreThoseOfItsDistances) {
    for (int i = 0; i < 5; ++i) {
        Node node = some_node();
        PlaneNode plane = some_plane();
        const Sighting sighting = some_sighting();
        const SightingCost cost(sighting, node, plane);
        Eigen::Matrix<double, 3, 6, Eigen::RowMajor> by_node;
        Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_plane;
        double* jacobians[] = {by_node.data(), by_plane.data()};
        Eigen::Vector3d residuals;
        cost.Evaluate(nullptr, residuals.data(), jacobians);
        const auto evaluate = [&] {
            node.update();
            Eigen::Vector3d moved;
            cost.Evaluate(nullptr, moved.data(), nullptr);
            return moved;
        };
        EXPECT_LT((measured<3>(node.change, evaluate) - by_node).norm(), 1e-4);
        EXPECT_LT((measured<3>(plane.change, evaluate) - by_plane).norm(), 1e-4);
    }
}

TEST(Residuals, NodesAreBroughtUpToDateWhenTheyMoved) {
    std::vector<Node> nodes(2, Node(Pose::Identity()));
    UpdateNodes update(nodes);
    nodes[1].change[0] = 3;
    update.PrepareForEvaluation(true, false);
    EXPECT_EQ(nodes[1].translation.x(), 0);
    update.PrepareForEvaluation(true, true);
    EXPECT_EQ(nodes[1].translation.x(), 3);
}

}  // namespace
}  // namespace planemap::graph
