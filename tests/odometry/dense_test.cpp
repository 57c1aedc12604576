// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/dense.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "seen_frame.hpp"

namespace planemap::odometry {
namespace {

DenseReference reference_of(const PreparedFrame& frame) {
    return make_dense_reference(frame.pyramid, *frame.depth, *frame.camera);
}

QuadraticTerm term(const DenseLevel& level, const PreparedFrame& frame, const Pose& camera_from_reference) {
    return photometric_term(level, frame.pyramid, frame.camera->color, camera_from_reference);
}

TEST(DenseTest, StepsLeadToTheTrueMotion) {
    const SeenFrame before(Pose::Identity());
    const Pose room_from_camera = small_motion(2, 2);
    const SeenFrame after(room_from_camera);
    Pose pose = Pose::Identity();
    for (const DenseLevel& level : reference_of(before.frame).levels) {
        for (int i = 0; i < 15; ++i) {
            const QuadraticTerm step = term(level, after.frame, pose);
            pose = pose_from_twist(-step.information.ldlt().solve(step.gradient)) * pose;
        }
    }
    const Pose truth = room_from_camera.inverse();
    EXPECT_LT(pose_error(pose, truth), 0.3 * pose_error(Pose::Identity(), truth));
}

TEST(DenseTest, AFrameFitsItselfAndItsInformationIsOne) {
    const SeenFrame seen(Pose::Identity());
    for (const DenseLevel& level : reference_of(seen.frame).levels) {
        const QuadraticTerm here = term(level, seen.frame, Pose::Identity());
        const Twist step = here.information.ldlt().solve(here.gradient);
        EXPECT_LT(step.norm(), 0.01);
        EXPECT_EQ(here.information, here.information.transpose());
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(here.information).eigenvalues()[0], 0);
    }
}

TEST(DenseTest, ExposureDoesNotMatter) {
    const SeenFrame seen(Pose::Identity());
    RenderedFrame brighter = render_room(room_camera(), Pose::Identity());
    for (std::uint8_t& pixel : brighter.gray.pixels) pixel = static_cast<std::uint8_t>(pixel + 20);
    const SeenFrame other(std::move(brighter));
    const DenseLevel level = reference_of(seen.frame).levels.at(0);
    const QuadraticTerm same = term(level, seen.frame, small_motion(0)),
                        bright = term(level, other.frame, small_motion(0));
    EXPECT_LT((same.gradient - bright.gradient).norm(), 0.02 * same.gradient.norm());
    EXPECT_LT((same.information - bright.information).norm(), 0.02 * same.information.norm());
}

TEST(DenseTest, NothingToSeeSaysNothing) {
    const SeenFrame seen(Pose::Identity()), black(black_frame());
    for (const DenseLevel& level : reference_of(black.frame).levels) {
        EXPECT_TRUE(level.points.empty());
        EXPECT_EQ(term(level, seen.frame, Pose::Identity()).information.norm(), 0);
    }
    const SeenFrame plain(Pose::Identity(), 0, false);
    for (const DenseLevel& level : reference_of(plain.frame).levels) EXPECT_TRUE(level.points.empty());
    EXPECT_TRUE(make_dense_reference({}, *seen.frame.depth, *seen.frame.camera).levels.empty())
        << "no colour";
}

TEST(DenseTest, WhatLiesBehindTheCameraSaysNothing) {
    const SeenFrame seen(Pose::Identity());
    Pose turned = Pose::Identity();
    turned.linear() = so3_exp({0, 3.14, 0});
    for (const DenseLevel& level : reference_of(seen.frame).levels)
        EXPECT_EQ(term(level, seen.frame, turned).information.norm(), 0);
}

}  // namespace
}  // namespace planemap::odometry
