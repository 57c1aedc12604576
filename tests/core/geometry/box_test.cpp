// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random_values.hpp"

namespace planemap {
namespace {

using test::Random;

Box random_box(Random& random, double place, double thinnest) {
    Box box;
    box.frame_from_box = random.pose(place);
    box.half_extents = {random.uniform(0.05, 2), random.uniform(0.05, 1), random.uniform(thinnest, 0.1)};
    return box;
}

/// Smallest distance found by projected gradient descent from many starts: slow, and right for convex sets.
double brute_force(const Box& a, const Box& b, Random& random) {
    const auto inside = [](const Box& box, const Eigen::Vector3d& q) -> Eigen::Vector3d {
        return q.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
    };
    double best = std::numeric_limits<double>::infinity();
    for (int start = 0; start < 4; ++start) {
        Eigen::Vector3d qa = inside(a, random.vector(2)), qb = inside(b, random.vector(2));
        Eigen::Vector3d last_a = qa, last_b = qb;
        for (int i = 1; i <= 5000; ++i) {  // Nesterov's accelerated projected gradient
            const double momentum = (i - 1.0) / (i + 2.0);
            const Eigen::Vector3d ya = qa + momentum * (qa - last_a), yb = qb + momentum * (qb - last_b);
            const Eigen::Vector3d gap = a.frame_from_box * ya - b.frame_from_box * yb;
            last_a = qa;
            last_b = qb;
            qa = inside(a, ya - 0.5 * a.frame_from_box.linear().transpose() * gap);
            qb = inside(b, yb + 0.5 * b.frame_from_box.linear().transpose() * gap);
            best = std::min(best, (a.frame_from_box * qa - b.frame_from_box * qb).norm());
        }
    }
    return best;
}

TEST(Box, CornersAreTheExtentsAwayFromTheCentre) {
    Random random(1);
    const Box box = random_box(random, 3, 0.01);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& corner : box.corners()) {
        const Eigen::Vector3d q = box.frame_from_box.inverse() * corner;
        EXPECT_TRUE(q.cwiseAbs().isApprox(box.half_extents, 1e-12));
        mean += corner / 8;
    }
    EXPECT_TRUE(mean.isApprox(box.frame_from_box.translation(), 1e-12));
}

TEST(Box, FaceIsCounterClockwiseAboutTheNormal) {
    Random random(2);
    const Box box = random_box(random, 3, 0.01);
    const auto face = box.face();
    for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector3d first = face[(i + 1) % 4] - face[i],
                              second = face[(i + 2) % 4] - face[(i + 1) % 4];
        EXPECT_GT(first.cross(second).dot(box.frame_from_box.linear().col(2)), 0);
    }
}

TEST(Box, PlaneAxesAreARotationWithTheNormalLast) {
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        const Eigen::Vector3d normal = random.direction();
        const Eigen::Vector3d along[] = {random.direction(), normal, -normal, Eigen::Vector3d::Zero(),
                                         Eigen::Vector3d(normal + 1e-9 * random.direction())};
        for (const Eigen::Vector3d& long_axis : along) {
            const Eigen::Matrix3d axes = plane_axes(normal, long_axis);
            EXPECT_TRUE(is_valid(Pose(axes)));
            EXPECT_TRUE(axes.col(2).isApprox(normal, 1e-12));
        }
        EXPECT_GT(plane_axes(normal, along[0]).col(0).dot(along[0]), 0);
    }
}

TEST(Box, BoundHoldsAllPointsTightly) {
    Random random(4);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 100; ++i) points.push_back(random.vector(2));
    const Box box = bound(random.pose().linear(), points);
    Eigen::Vector3d reach = Eigen::Vector3d::Zero();
    for (const auto& p : points) reach = reach.cwiseMax((box.frame_from_box.inverse() * p).cwiseAbs());
    EXPECT_TRUE(reach.isApprox(box.half_extents, 1e-12));
}

TEST(Box, BoundOfNothingHasNoExtent) {
    const Box box = bound(Eigen::Matrix3d::Identity(), std::vector<Eigen::Vector3d>{});
    EXPECT_TRUE(box.half_extents.isZero());
    EXPECT_TRUE(is_valid(box.frame_from_box));
}

TEST(Box, DistanceIsTheGapByBruteForce) {
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        const Box a = random_box(random, 2, 0.0), b = random_box(random, 2, 0.0);
        const double truth = brute_force(a, b, random);
        EXPECT_NEAR(distance(a, b), truth, 1e-3) << "case " << i;
        EXPECT_NEAR(distance(a, b), distance(b, a), 1e-6);
        const Pose moved = random.pose();
        EXPECT_NEAR(distance(moved * a, moved * b), distance(a, b), 1e-6);
    }
}

TEST(Box, DistanceOfNearlyParallelWalls) {
    // Two long walls, half a metre apart at one end and converging at one degree: the gap is at the far end.
    Box a, b;
    a.half_extents = b.half_extents = {5, 1, 0};
    const double angle = 0.0175;
    b.frame_from_box = Eigen::Translation3d(0, 0, 0.5) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
    EXPECT_NEAR(distance(a, b), 0.5 - 5 * std::sin(angle), 1e-3);
}

TEST(Box, DistanceIsZeroWhenTheyOverlapCrossOrTouch) {
    Random random(6);
    for (int i = 0; i < 100; ++i) {
        const Box a = random_box(random, 2, 0.0);
        Box b = random_box(random, 2, 0.0);
        const Eigen::Vector3d in_a = a.frame_from_box * (0.9 * random.uniform(-1, 1) * a.half_extents);
        const Eigen::Vector3d in_b = b.frame_from_box * (0.9 * random.uniform(-1, 1) * b.half_extents);
        b.frame_from_box.pretranslate(in_a - in_b);
        EXPECT_NEAR(distance(a, b), 0.0, 1e-6) << "case " << i;
    }
    Box a, b;
    a.half_extents = b.half_extents = {1, 1, 0};
    b.frame_from_box.translation() = Eigen::Vector3d(2, 0, 0);
    EXPECT_NEAR(distance(a, b), 0.0, 1e-9) << "edge to edge in one plane";
    EXPECT_NEAR(distance(a, a), 0.0, 1e-9);
}

TEST(Box, DistanceOfFlatBoxesInOnePlaneAndOfPoints) {
    Box a, b;
    a.half_extents = b.half_extents = {1, 1, 0};
    b.frame_from_box.translation() = Eigen::Vector3d(2.3, 0, 0);
    EXPECT_NEAR(distance(a, b), 0.3, 1e-9);
    b.frame_from_box.translation() = Eigen::Vector3d(2.3, 2.4, 0);
    EXPECT_NEAR(distance(a, b), 0.5, 1e-9);
    b.half_extents.setZero();
    b.frame_from_box.translation() = Eigen::Vector3d(0.2, 0.1, -0.7);
    EXPECT_NEAR(distance(a, b), 0.7, 1e-9);
}

}  // namespace
}  // namespace planemap
