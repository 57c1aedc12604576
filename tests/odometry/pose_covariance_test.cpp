// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/pose_covariance.hpp"

#include <gtest/gtest.h>

namespace planemap::odometry {
namespace {

/// A frame whose first direction is known by the guess alone, all others by what it saw.
struct Degenerate {
    Located located;
    Guess predicted;

    Degenerate() {
        predicted.information = 100 * Matrix6d::Identity();  // a tenth of a metre
        Matrix6d seen = 1e6 * Matrix6d::Identity();
        seen(0, 0) = 0;
        located.track.alignment.information = predicted.information + seen;
        located.track.degenerate = true;
    }
};

TEST(PoseCovarianceTest, WhereAllIsSeenItIsWhatTheFrameMeasured) {
    PoseCovariance covariance;
    Degenerate frame;
    frame.located.track.degenerate = false;
    for (int i = 0; i < 3; ++i) {
        covariance.follow(frame.located, frame.predicted, i > 0);
        EXPECT_TRUE(covariance.measured() == frame.located.covariance());
    }
}

TEST(PoseCovarianceTest, WhereADirectionIsNotSeenItAddsUpFasterThanTheFrames) {
    PoseCovariance covariance;
    const Degenerate frame;
    double last = 0, last_step = 0;
    for (int i = 0; i < 5; ++i) {
        covariance.follow(frame.located, frame.predicted, i > 0);
        const double now = covariance.measured()(0, 0);
        EXPECT_GT(now - last, last_step) << i;
        last_step = now - last;
        last = now;
        EXPECT_NEAR(covariance.measured()(1, 1), frame.located.covariance()(1, 1), 1e-6) << "it is seen";
    }
    EXPECT_TRUE(covariance.measured().isApprox(covariance.measured().transpose()));
}

TEST(PoseCovarianceTest, AnotherKeyframeAPriorAndAStartBeginItAnew) {
    const Degenerate frame;
    PoseCovariance first;
    first.follow(frame.located, frame.predicted, false);
    PoseCovariance covariance;
    for (int i = 0; i < 3; ++i) covariance.follow(frame.located, frame.predicted, i > 0);
    const double grown = covariance.measured()(0, 0);

    PoseCovariance other = covariance;
    other.follow(frame.located, frame.predicted, false);
    EXPECT_LT(other.measured()(0, 0), covariance.measured()(0, 0) + grown) << "but its steps go on";

    Degenerate told;
    told.located.track.by_prior = true;
    PoseCovariance prior = covariance;
    prior.follow(told.located, told.predicted, true);
    EXPECT_TRUE(prior.measured() == told.located.covariance());

    covariance.start();
    EXPECT_TRUE(covariance.measured().isZero());
    covariance.follow(frame.located, frame.predicted, false);
    EXPECT_TRUE(covariance.measured() == first.measured());
}

TEST(PoseCovarianceTest, SaysWhereUpToTenCentimetresAndFiveDegreesOfThreeSigma) {
    Matrix6d covariance = Matrix6d::Zero();
    EXPECT_TRUE(says_where(covariance));
    covariance(1, 1) = std::pow(0.099 / 3, 2);
    covariance(4, 4) = std::pow(4.9 * M_PI / 180 / 3, 2);
    EXPECT_TRUE(says_where(covariance));
    Matrix6d far = covariance, turned = covariance;
    far(1, 1) = std::pow(0.101 / 3, 2);
    turned(4, 4) = std::pow(5.1 * M_PI / 180 / 3, 2);
    EXPECT_FALSE(says_where(far));
    EXPECT_FALSE(says_where(turned));
}

}  // namespace
}  // namespace planemap::odometry
