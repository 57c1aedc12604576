// SPDX-License-Identifier: BSD-3-Clause
#include "graph/optimisation.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/random_values.hpp"

namespace planemap::graph {
namespace {

using test::Random;

/// A ring of poses, the edges between neighbours and from the last to the first, all exact.
struct Ring {
    std::vector<Pose> truth;
    std::vector<PoseEdge> edges;
};

Ring make_ring(int count, Random& random) {
    Ring ring;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        Pose pose = Pose::Identity();
        pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix() *
                        so3_exp(0.2 * random.direction());
        pose.translation() =
            Eigen::Vector3d(2 * std::cos(angle), 0.1 * random.uniform(-1, 1), 2 * std::sin(angle));
        ring.truth.push_back(pose);
    }
    for (int i = 0; i < count; ++i) {
        const int next = (i + 1) % count;
        PoseEdge edge;
        edge.from = i;
        edge.to = next;
        edge.from_from_to =
            ring.truth[static_cast<std::size_t>(i)].inverse() * ring.truth[static_cast<std::size_t>(next)];
        edge.sqrt_information = sqrt_information(Matrix6d::Zero(), 0.01, 0.005);
        ring.edges.push_back(edge);
    }
    return ring;
}

std::vector<Pose> disturbed(const std::vector<Pose>& poses, Random& random, double size) {
    std::vector<Pose> result = poses;
    for (std::size_t i = 1; i < result.size(); ++i) result[i] = result[i] * random.pose(size, size);
    return result;
}

double largest_error(const std::vector<Pose>& a, const std::vector<Pose>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, twist_from_pose(a[i].inverse() * b[i]).norm());
    return largest;
}

TEST(Optimisation, ExactEdgesGiveTheTruthFromAfar) {
    Random random(1);
    const Ring ring = make_ring(30, random);
    std::vector<Pose> poses = disturbed(ring.truth, random, 0.5);
    const OptimisationReport report = optimise(poses, ring.edges, 0, {});
    EXPECT_TRUE(report.converged);
    EXPECT_TRUE(report.usable);
    EXPECT_LT(largest_error(poses, ring.truth), 1e-4);
    EXPECT_EQ(poses[0].matrix(), ring.truth[0].matrix());
}

TEST(Optimisation, ErrorOfAnEdgeIsTheWhitenedTwist) {
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        PoseEdge edge;
        edge.from_from_to = random.pose();
        edge.sqrt_information = Matrix6d::Random();
        const Pose world_from_from = random.pose();
        Twist small = 1e-3 * Twist::Random();
        const Twist error =
            edge_error(edge, world_from_from, world_from_from * edge.from_from_to * pose_from_twist(small));
        EXPECT_LT((error - edge.sqrt_information * small).norm(), 1e-7);
    }
}

TEST(Optimisation, TheOptimumIsStationary) {
    Random random(3);
    Ring ring = make_ring(12, random);
    for (PoseEdge& edge : ring.edges) edge.from_from_to = edge.from_from_to * random.pose(0.02, 0.02);
    std::vector<Pose> poses = ring.truth;
    optimise(poses, ring.edges, 0, {});
    const auto cost = [&](const std::vector<Pose>& at) {
        double sum = 0;
        for (const PoseEdge& edge : ring.edges)
            sum += edge_error(edge, at[static_cast<std::size_t>(edge.from)],
                              at[static_cast<std::size_t>(edge.to)])
                       .squaredNorm();
        return sum;
    };
    const double best = cost(poses);
    for (int i = 0; i < 200; ++i) {
        std::vector<Pose> other = poses;
        const auto node = static_cast<std::size_t>(random.integer(1, 11));
        other[node] = other[node] * random.pose(0.003, 0.003);
        EXPECT_GE(cost(other), best * (1 - 1e-6));
    }
}

TEST(Optimisation, DoesNotDependOnTheWorldFrame) {
    Random random(4);
    Ring ring = make_ring(10, random);
    for (PoseEdge& edge : ring.edges) edge.from_from_to = edge.from_from_to * random.pose(0.02, 0.02);
    const Pose moved = random.pose();
    std::vector<Pose> here = ring.truth, there;
    for (const Pose& pose : here) there.push_back(moved * pose);
    optimise(here, ring.edges, 0, {});
    optimise(there, ring.edges, 0, {});
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_LT(twist_from_pose(there[i].inverse() * (moved * here[i])).norm(), 1e-4);
    }
}

TEST(Optimisation, TheKernelLetsGoOfAWrongEdge) {
    Random random(5);
    Ring ring = make_ring(30, random);
    PoseEdge wrong = ring.edges[0];
    wrong.from = 3;
    wrong.to = 18;
    wrong.from_from_to = Pose::Identity();
    wrong.robust = true;
    ring.edges.push_back(wrong);
    std::vector<Pose> robust = ring.truth, plain = ring.truth;
    optimise(robust, ring.edges, 0, {1.0, 50});
    optimise(plain, ring.edges, 0, {0.0, 50});
    EXPECT_LT(largest_error(robust, ring.truth), 0.01);
    EXPECT_GT(largest_error(plain, ring.truth), 0.3);
}

TEST(Optimisation, SqrtInformationInvertsTheCovariance) {
    Random random(6);
    const Matrix6d half = Matrix6d::Random();
    const Matrix6d covariance = half * half.transpose();
    Matrix6d sum = covariance;
    sum.diagonal() += (Twist() << 0.01, 0.01, 0.01, 0.04, 0.04, 0.04).finished();
    const Matrix6d w = sqrt_information(covariance, 0.1, 0.2);
    EXPECT_TRUE((w.transpose() * w * sum).isIdentity(1e-9));
}

TEST(Optimisation, UnusableCovariancesCountAsUnknown) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Matrix6d negative = -Matrix6d::Identity(), bad = Matrix6d::Zero(), huge = Matrix6d::Identity() * 1e300;
    bad(2, 3) = nan;
    for (const Matrix6d& covariance :
         {negative, bad, huge, Matrix6d(Matrix6d::Constant(nan)),
          Matrix6d(Matrix6d::Constant(std::numeric_limits<double>::infinity()))}) {
        const Matrix6d w = sqrt_information(covariance, 0.01, 0.01);
        EXPECT_TRUE(w.allFinite());
        EXPECT_NEAR(w(0, 0), 1 / 0.3, 0.1);
    }
    EXPECT_NEAR(sqrt_information(Matrix6d::Zero(), 0.01, 0.02)(0, 0), 100, 1e-6);
    EXPECT_NEAR(sqrt_information(Matrix6d::Zero(), 0.01, 0.02)(5, 5), 50, 1e-6);
}

TEST(Optimisation, TwoThousandNodesOverTenLaps) {
    Random random(7);
    constexpr int kNodes = 2000, kLap = 200;
    Ring ring = make_ring(kLap, random);
    std::vector<Pose> truth, drifted;
    std::vector<PoseEdge> edges;
    const auto add = [&](int from, int to, double noise, bool robust) {
        PoseEdge edge = ring.edges[0];
        edge.from = from;
        edge.to = to;
        edge.robust = robust;
        edge.from_from_to = truth[static_cast<std::size_t>(from)].inverse() *
                            truth[static_cast<std::size_t>(to)] * random.pose(noise, noise);
        edges.push_back(edge);
    };
    for (int i = 0; i < kNodes; ++i) {
        truth.push_back(ring.truth[static_cast<std::size_t>(i % kLap)]);
        if (i > 0) add(i - 1, i, 0.003, false);
        drifted.push_back(
            i == 0 ? truth[0] : Pose(drifted.back() * edges[static_cast<std::size_t>(i - 1)].from_from_to));
    }
    for (int i = kLap; i < kNodes; i += 5) add(i - kLap, i, 0.003, true);
    std::vector<Pose> poses = drifted;
    optimise(poses, edges, 0, {0.0, 30});
    const OptimisationReport report = optimise(poses, edges, 0, {3.0, 30});
    EXPECT_TRUE(report.converged);
    EXPECT_LT(largest_error(poses, truth), largest_error(drifted, truth) / 5);
    std::vector<Pose> from_truth = truth;
    optimise(from_truth, edges, 0, {3.0, 30});
    EXPECT_LT(largest_error(from_truth, poses), 0.005) << "wherever it starts";
    std::vector<Pose> again = drifted;
    optimise(again, edges, 0, {0.0, 30});
    optimise(again, edges, 0, {3.0, 30});
    for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].matrix(), poses[i].matrix());
}

TEST(Optimisation, NothingToDo) {
    std::vector<Pose> none, one{Pose::Identity()};
    EXPECT_TRUE(optimise(none, {}, 0, {}).converged);
    EXPECT_TRUE(optimise(one, {}, 0, {}).converged);
}

}  // namespace
}  // namespace planemap::graph
