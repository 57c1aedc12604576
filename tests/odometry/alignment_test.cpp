// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/alignment.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap::odometry {
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
        ASSERT_TRUE(point_residual(kCamera, term, pose * term.point, residual, &jacobian));
        for (int i = 0; i < 6; ++i) {
            const double step = 1e-6;
            Eigen::Vector3d up, down;
            ASSERT_TRUE(point_residual(kCamera, term,
                                       pose_from_twist(step * Twist::Unit(i)) * pose * term.point, up));
            ASSERT_TRUE(point_residual(kCamera, term,
                                       pose_from_twist(-step * Twist::Unit(i)) * pose * term.point, down));
            const Eigen::Vector3d numeric = (up - down) / (2 * step);
            EXPECT_LT((numeric - jacobian.col(i)).norm(), 1e-4 * (1 + numeric.norm())) << "column " << i;
        }
    }
}

TEST(PointResidual, NothingBehindTheCamera) {
    PointTerm term;
    term.point = {0, 0, -1};
    Eigen::Vector3d residual;
    EXPECT_FALSE(point_residual(kCamera, term, Pose::Identity() * term.point, residual));
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

/// Points as a rolling shutter shows them to a camera at `pose` that moves with `velocity`.
std::vector<PointTerm> rolling_points(const Pose& pose, const Twist& velocity, double readout_s, int count) {
    std::vector<PointTerm> terms = seen_points(pose, count, 9);
    for (PointTerm& term : terms) {
        for (int i = 0; i < 5; ++i) {
            const double late = readout_s * row_share(kCamera, term.pixel.y());
            const Eigen::Vector3d p = pose_from_twist(late * velocity) * pose * term.point;
            term.pixel = kCamera.project(p);
            term.inverse_depth = 1 / p.z();
        }
    }
    return terms;
}

TEST(Align, ARollingShutterIsUndone) {
    Twist velocity;
    velocity << 0.4, 0.1, 0, 0.5, 1.5, -0.3;
    const std::vector<PointTerm> terms = rolling_points(some_motion(), velocity, 0.03, 100);
    Alignment alignment;
    alignment.camera = kCamera;
    alignment.points = terms;
    alignment.velocity = velocity;
    alignment.color_offset_sigma_s = 1e-4;
    const auto error = [&] {
        const AlignmentResult result = align(alignment, Pose::Identity());
        return twist_from_pose(result.camera_from_keyframe * some_motion().inverse()).norm();
    };
    const double rolling = error();
    alignment.readout_s = 0.03;
    EXPECT_LT(error(), 1e-3);
    EXPECT_LT(error(), 0.1 * rolling);
}

TEST(Align, TellsTheReadout) {
    Twist velocity;
    velocity << 0, 0, 0, 0.5, 1, -0.3;
    for (const double readout_s : {0.0, 0.02, -0.02}) {
        const std::vector<PointTerm> terms = rolling_points(some_motion(), velocity, readout_s, 200);
        Alignment alignment;
        alignment.camera = kCamera;
        alignment.points = terms;
        alignment.velocity = velocity;
        double estimate = 0;
        for (int i = 0; i < 6; ++i) {
            alignment.readout_s = estimate;
            const AlignmentResult result = align(alignment, some_motion());
            ASSERT_GT(result.readout_information, 0);
            estimate -= result.readout_gradient / result.readout_information;
        }
        EXPECT_NEAR(estimate, readout_s, 2e-3);
    }
}

TEST(Align, ACameraAtRestSaysNothingOfTheReadout) {
    const std::vector<PointTerm> terms = seen_points(some_motion(), 100, 5);
    Alignment alignment;
    alignment.camera = kCamera;
    alignment.points = terms;
    const AlignmentResult result = align(alignment, some_motion());
    EXPECT_EQ(result.readout_information, 0);
    EXPECT_EQ(result.readout_gradient, 0);
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

TEST(TileOf, CoversTheImageAndWhatIsBesideIt) {
    EXPECT_EQ(tile_of(kCamera, 0, 0), 0);
    EXPECT_EQ(tile_of(kCamera, 639, 479), kTiles - 1);
    EXPECT_EQ(tile_of(kCamera, 639, 0), kTileColumns - 1);
    EXPECT_EQ(tile_of(kCamera, -1e9, -1e9), 0);
    EXPECT_EQ(tile_of(kCamera, 1e9, 1e9), kTiles - 1);
}

/// Rotation about y of the points' errors and its covariance, over many sets of points. The error of a pixel
/// is its own, of one pixel, and that of its tile, of `shared` pixels.
std::pair<double, double> found_and_said(double shared) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 1);
    double found = 0, said = 0;
    constexpr int kRuns = 200;
    for (int run = 0; run < kRuns; ++run) {
        std::vector<PointTerm> terms = seen_points(some_motion(), 300, static_cast<std::uint64_t>(run));
        std::vector<Eigen::Vector2d> of_tiles(kTiles);
        for (Eigen::Vector2d& error : of_tiles)
            error = shared * Eigen::Vector2d(noise(random), noise(random));
        for (PointTerm& term : terms) {
            const auto tile = static_cast<std::size_t>(tile_of(kCamera, term.pixel.x(), term.pixel.y()));
            term.pixel += Eigen::Vector2d(noise(random), noise(random)) + of_tiles[tile];
        }
        Alignment alignment;
        alignment.camera = kCamera;
        alignment.points = terms;
        alignment.loss_scale = 100;
        const AlignmentResult result = align(alignment, some_motion());
        const Twist error = twist_from_pose(result.camera_from_keyframe * some_motion().inverse());
        found += error(4) * error(4) / kRuns;
        said += covariance_of(result)(4, 4) / kRuns;
    }
    return {found, said};
}

TEST(CovarianceOf, HoldsWhereNeighboursErrTogether) {
    const auto [found, said] = found_and_said(2);
    EXPECT_GT(said, 0.5 * found);
    EXPECT_LT(said, 4 * found);
}

TEST(CovarianceOf, IsNotFarTooWideWhereTheyDoNot) {
    const auto [found, said] = found_and_said(0);
    EXPECT_GT(said, found);
    EXPECT_LT(said, 4 * found);
}

TEST(CovarianceOf, OfThePriorAloneIsThePriors) {
    Alignment alignment;
    alignment.camera = kCamera;
    alignment.quadratics.push_back({some_motion(), 4 * Matrix6d::Identity(), Twist::Zero(), true});
    const AlignmentResult result = align(alignment, some_motion());
    EXPECT_EQ(result.scatter.norm(), 0);
    EXPECT_LT((covariance_of(result) - Matrix6d::Identity() / 4).norm(), 1e-9);
}

}  // namespace
}  // namespace planemap::odometry
