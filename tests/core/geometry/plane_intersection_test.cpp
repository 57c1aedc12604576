// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/plane_intersection.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace planemap {
namespace {

const Plane kFloor{Eigen::Vector3d::UnitZ(), 0}, kWall{-Eigen::Vector3d::UnitX(), 2},
    kOther{-Eigen::Vector3d::UnitY(), 3};

TEST(PlaneIntersection, TheLineIsOnBothAndStartsNearest) {
    const Plane slope{Eigen::Vector3d(1, 2, -3).normalized(), 0.7};
    const Eigen::Vector3d near(4, -5, 6);
    const auto line = common_line(kWall, slope, near, 0.1);
    ASSERT_TRUE(line);
    for (const double along : {-3.0, 0.0, 8.0}) {
        const Eigen::Vector3d p = line->origin + along * line->direction;
        EXPECT_NEAR(kWall.signed_distance(p), 0, 1e-12);
        EXPECT_NEAR(slope.signed_distance(p), 0, 1e-12);
    }
    EXPECT_NEAR(line->direction.norm(), 1, 1e-12);
    EXPECT_NEAR((line->origin - near).dot(line->direction), 0, 1e-12);
    EXPECT_GT(line->direction.dot(kWall.normal.cross(slope.normal)), 0);
}

TEST(PlaneIntersection, FlatPairsHaveNoLine) {
    const Plane tilted{Eigen::Vector3d(std::sin(radians(10)), 0, std::cos(radians(10))), 0};
    EXPECT_FALSE(common_line(kFloor, tilted, Eigen::Vector3d::Zero(), std::sin(kParallel_rad)));
    EXPECT_TRUE(common_line(kFloor, tilted, Eigen::Vector3d::Zero(), std::sin(radians(9))));
    EXPECT_FALSE(common_line(kFloor, kFloor, Eigen::Vector3d::Zero(), 1e-3));
    const Plane broken{Eigen::Vector3d::Constant(std::nan("")), 0};
    EXPECT_FALSE(common_line(kFloor, broken, Eigen::Vector3d::Zero(), 1e-3));
}

TEST(PlaneIntersection, APointIsAsWellDefinedAsTheLineOfTheFlattestPair) {
    EXPECT_NEAR(least_volume(std::acos(-1.0) / 2), 1, 1e-12) << "three planes square to each other";
    EXPECT_NEAR(least_volume(kParallel_rad), std::sin(kParallel_rad) * std::sin(kParallel_rad), 1e-12);
    EXPECT_EQ(least_volume(0), 0);
}

TEST(PlaneIntersection, ThreePlanesShareACorner) {
    const auto corner = common_point(kFloor, kWall, kOther, 0.1);
    ASSERT_TRUE(corner);
    EXPECT_TRUE(corner->isApprox(Eigen::Vector3d(2, 3, 0)));
    const Plane along{Eigen::Vector3d(0, 1, 1).normalized(), 0};
    const Plane also_along{Eigen::Vector3d(0, 1, -1).normalized(), 0};
    EXPECT_FALSE(common_point(kFloor, along, also_along, 1e-4)) << "all hold the x axis";
}

}  // namespace
}  // namespace planemap
