// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

namespace planemap {
namespace {

TEST(LargestSigma, IsThatOfTheWorstDirectionHoweverItIsTurned) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
    const Eigen::Vector3d variances(1e-4, 9e-4, 4e-4);
    EXPECT_NEAR(largest_sigma(turn * variances.asDiagonal() * turn.transpose()), 0.03, 1e-12);
    EXPECT_EQ(largest_sigma(Eigen::Matrix3d::Zero()), 0);
    EXPECT_EQ(largest_sigma(-1e-18 * Eigen::Matrix3d::Identity()), 0) << "rounding";
}

TEST(LargestSigma, WhatIsNoNumberIsNotCertain) {
    const Eigen::Matrix3d unknown = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(largest_sigma(unknown) < 1e9);
}

}  // namespace
}  // namespace planemap
