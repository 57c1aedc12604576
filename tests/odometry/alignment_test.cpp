// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/alignment.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap {
namespace {

const PinholeCamera kCamera{640, 480, 525, 520, 320, 240};

Pose some_motion() {
    Twist twist;
    twist << 0.1, -0.05, 0.08, 0.05, -0.08, 0.1;
    return pose_from_twist(twist);
}

std::vector<PointTerm> seen_points(const Pose& camera_from_keyframe, int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> x(-1, 1), z(1, 4);
    std::vector<PointTerm> terms;
    for (int i = 0; i < count; ++i) {
        PointTerm term;
        term.point = {x(random), x(random), z(random)};
        const Eigen::Vector3d p = camera_from_keyframe * term.point;
        term.pixel = kCamera.project(p);
        term.inverse_depth = 1 / p.z();
        term.inverse_depth_sigma = 0.005;
        terms.push_back(term);
    }
    return terms;
}

TEST(PointResidual, JacobianMatchesDifferences) {
    for (const PointTerm& term : seen_points(Pose::Identity(), 20, 3)) {
        const Pose pose = some_motion();
        Eigen::Vector3d residual;
        Eigen::Matrix<double, 3, 6> jacobian;
        ASSERT_TRUE(point_residual(kCamera, term, pose, residual, &jacobian));
        for (int i = 0; i < 6; ++i) {
            const double step = 1e-6;
            Eigen::Vector3d up, down;
            ASSERT_TRUE(point_residual(kCamera, term, pose_from_twist(step * Twist::Unit(i)) * pose, up));
            ASSERT_TRUE(point_residual(kCamera, term, pose_from_twist(-step * Twist::Unit(i)) * pose, down));
            const Eigen::Vector3d numeric = (up - down) / (2 * step);
            EXPECT_LT((numeric - jacobian.col(i)).norm(), 1e-4 * (1 + numeric.norm())) << "column " << i;
        }
    }
}

TEST(PointResidual, NothingBehindTheCamera) {
    PointTerm term;
    term.point = {0, 0, -1};
    Eigen::Vector3d residual;
    EXPECT_FALSE(point_residual(kCamera, term, Pose::Identity(), residual));
}

TEST(Align, FindsTheMotionDespiteOutliers) {
    std::vector<PointTerm> terms = seen_points(some_motion(), 100, 5);
    for (std::size_t i = 0; i < 20; ++i) terms[i].pixel += Eigen::Vector2d(40, -30);
    Alignment alignment;
    alignment.camera = kCamera;
    alignment.points = terms;
    const AlignmentResult result = align(alignment, Pose::Identity());
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.inliers, 80);
    EXPECT_LT(twist_from_pose(result.camera_from_keyframe * some_motion().inverse()).norm(), 1e-3);
}

TEST(Align, TellsTheTimeOffsetWhenDepthSaysWhereTheCameraIs) {
    Twist velocity;
    velocity << 0.5, 0, 0, 0, 0.8, 0;
    const double offset = 0.008;
    std::vector<PointTerm> terms = seen_points(pose_from_twist(offset * velocity) * some_motion(), 100, 5);
    for (PointTerm& term : terms) term.inverse_depth = 0;
    Alignment alignment;
    alignment.camera = kCamera;
    alignment.points = terms;
    alignment.velocity = velocity;
    alignment.quadratics.push_back({some_motion(), 1e9 * Matrix6d::Identity(), Twist::Zero()});
    const AlignmentResult result = align(alignment, some_motion());
    EXPECT_NEAR(result.color_offset_s, offset, 1e-3);
    EXPECT_LT(twist_from_pose(result.camera_from_keyframe * some_motion().inverse()).norm(), 1e-3);
}

TEST(Align, WithoutAnythingStaysAtTheGuess) {
    Alignment alignment;
    alignment.camera = kCamera;
    alignment.quadratics.push_back({some_motion(), Matrix6d::Identity(), Twist::Zero()});
    const AlignmentResult result = align(alignment, some_motion());
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.inliers, 0);
    EXPECT_LT(twist_from_pose(result.camera_from_keyframe * some_motion().inverse()).norm(), 1e-9);
}

TEST(Align, InformationGrowsWithTheNumberOfPoints) {
    const std::vector<PointTerm> terms = seen_points(some_motion(), 200, 7);
    Alignment few, many;
    few.camera = many.camera = kCamera;
    few.points = std::span(terms).first(50);
    many.points = terms;
    const double little = align(few, some_motion()).information.determinant();
    EXPECT_LT(little, align(many, some_motion()).information.determinant());
}

}  // namespace
}  // namespace planemap
