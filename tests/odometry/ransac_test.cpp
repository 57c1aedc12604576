// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/ransac.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap::odometry {
namespace {

const MotionRansacOptions kOptions = motion_ransac_options({});

const PinholeCamera kCamera{640, 480, 525, 525, 320, 240};

Pose some_motion() {
    Twist twist;
    twist << 0.2, -0.1, 0.15, 0.1, -0.2, 0.3;
    return pose_from_twist(twist);
}

/// Points seen after `motion`; a share of them somewhere else.
std::vector<PointTerm> seen_points(const Pose& motion, int count, double outliers) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> x(-1, 1), z(1.5, 4), share(0, 1), u(0, 640), v(0, 480);
    std::vector<PointTerm> terms;
    for (int i = 0; i < count; ++i) {
        PointTerm term;
        term.point = {x(random), x(random), z(random)};
        const Eigen::Vector3d p = motion * term.point;
        term.pixel = kCamera.project(p);
        term.inverse_depth = 1 / p.z();
        term.inverse_depth_sigma = 0.005;
        if (share(random) < outliers) {
            term.pixel = {u(random), v(random)};
            term.inverse_depth = 1 / z(random);
        }
        terms.push_back(term);
    }
    return terms;
}

TEST(Ransac, RecoversAMotionFromHalfOutliers) {
    const std::optional<Pose> pose = ransac_motion(kCamera, seen_points(some_motion(), 100, 0.5), kOptions);
    ASSERT_TRUE(pose);
    EXPECT_LT(twist_from_pose(*pose * some_motion().inverse()).norm(), 1e-3);
}

TEST(Ransac, SameSeedSameMotion) {
    const std::vector<PointTerm> terms = seen_points(some_motion(), 100, 0.5);
    EXPECT_TRUE(
        ransac_motion(kCamera, terms, kOptions)->isApprox(*ransac_motion(kCamera, terms, kOptions), 0));
}

TEST(Ransac, NothingFromNoise) {
    EXPECT_FALSE(ransac_motion(kCamera, seen_points(some_motion(), 60, 1), kOptions));
}

TEST(Ransac, NothingFromTooFewOrDegeneratePoints) {
    EXPECT_FALSE(ransac_motion(kCamera, {}, kOptions));
    const std::vector<PointTerm> terms = seen_points(some_motion(), 20, 0);
    EXPECT_FALSE(ransac_motion(kCamera, std::span(terms).first(2), kOptions));
    EXPECT_FALSE(ransac_motion(kCamera, std::vector<PointTerm>(30, terms[0]), kOptions));
    std::vector<PointTerm> line;
    for (int i = 0; i < 30; ++i) {
        PointTerm term;
        term.point = {0.05 * i - 0.7, 0, 2};
        term.pixel = kCamera.project(term.point);
        term.inverse_depth = 0.5;
        line.push_back(term);
    }
    EXPECT_FALSE(ransac_motion(kCamera, line, kOptions));
}

TEST(Ransac, NothingWithoutDepth) {
    std::vector<PointTerm> terms = seen_points(some_motion(), 50, 0);
    for (PointTerm& term : terms) term.inverse_depth = 0;
    EXPECT_FALSE(ransac_motion(kCamera, terms, kOptions));
}

}  // namespace
}  // namespace planemap::odometry
