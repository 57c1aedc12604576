// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/consistency.hpp"

#include <gtest/gtest.h>

#include "bench_segmentation/two_walls.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::bench {
namespace {

/// A sighting of the plane z = height, tilted and shifted.
Sighting sighting(double height, double tilt_deg = 0, double shift_m = 0, double pixels = 1000) {
    const double tilt = radians(tilt_deg);
    const Eigen::Vector3d normal(std::sin(tilt), 0, std::cos(tilt)), centroid(0, 0, height + shift_m);
    return {{normal, -normal.dot(centroid)}, centroid, pixels};
}

TEST(WorldPlanes, TheSamePlaneEveryTimeHasNoSpread) {
    WorldPlanes planes;
    for (int i = 0; i < 10; ++i) planes.add(sighting(1));
    const Spread spread = planes.spread_of_largest(5);
    EXPECT_EQ(spread.planes, 1);
    EXPECT_NEAR(spread.angle_deg, 0, 1e-5);
    EXPECT_NEAR(spread.distance_m, 0, 1e-9);
}

TEST(WorldPlanes, SpreadIsTheStandardDeviation) {
    WorldPlanes planes;
    for (int i = 0; i < 200; ++i) planes.add(sighting(1, i % 2 == 0 ? 1 : -1, i % 4 < 2 ? 0.01 : -0.01));
    const Spread spread = planes.spread_of_largest(5);
    EXPECT_NEAR(spread.angle_deg, 1, 0.01);
    EXPECT_NEAR(spread.distance_m, 0.01, 0.0005);
}

TEST(WorldPlanes, SightingsCountByTheirPixels) {
    WorldPlanes planes;
    for (int i = 0; i < 100; ++i) {
        planes.add(sighting(1, 0, i % 2 == 0 ? 0.001 : -0.001, 1e6));
        planes.add(sighting(1, i % 2 == 0 ? 5 : -5, 0.02, 1));
    }
    EXPECT_NEAR(planes.spread_of_largest(5).distance_m, 0.001, 1e-4);
    EXPECT_LT(planes.spread_of_largest(5).angle_deg, 0.1);
}

TEST(WorldPlanes, PlanesApartAreToldApartAndTheMedianIsTaken) {
    WorldPlanes planes;
    for (int i = 0; i < 30; ++i) {
        const double sign = i % 2 == 0 ? 1 : -1;
        planes.add(sighting(0, 0, 0.001 * sign));
        planes.add(sighting(1, 0, 0.002 * sign));
        planes.add(sighting(2, 0, 0.009 * sign));
        planes.add(sighting(3, 0, 0.03 * sign, 10));  // smaller than the first three
        planes.add(sighting(0, 30, 0, 10));           // another direction
    }
    EXPECT_EQ(planes.spread_of_largest(5).planes, 5);
    EXPECT_EQ(planes.spread_of_largest(3).planes, 3);
    EXPECT_NEAR(planes.spread_of_largest(3).distance_m, 0.002, 1e-4);
}

TEST(WorldPlanes, WhatWasSeenTwiceOrNeverHasNone) {
    WorldPlanes planes;
    EXPECT_EQ(planes.spread_of_largest(5).planes, 0);
    planes.add(sighting(1));
    planes.add(sighting(1));
    EXPECT_EQ(planes.spread_of_largest(5).planes, 0);
}

}  // namespace
}  // namespace planemap::bench
