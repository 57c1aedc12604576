// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/surface_check.hpp"

#include <gtest/gtest.h>

#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

CameraInfo camera() {
    CameraInfo camera;
    camera.depth = camera.color = {160, 120, 130, 130, 79.5, 59.5};
    return camera;
}

/// A camera at the origin that looks along z at a wall 2 m away; and one that is not there, from elsewhere.
const Face kWall{"wall", {0, 0, 2}, {0, 0, -1}, {1, 0, 0}, 1, 0.8};

std::vector<SurfaceCheck> checked(const Face& mapped) {
    PlaneMap map;
    map.planes.push_back(map_plane(5, mapped));
    SurfaceChecker checker(map);
    checker.add(DepthImage(160, 120, 2000), camera(), Pose::Identity());
    return checker.checks();
}

TEST(SurfaceCheck, AMapPlaneOnTheSurfaceIsRight) {
    const auto checks = checked(kWall);
    ASSERT_EQ(checks.size(), 1u);
    EXPECT_EQ(checks[0].id, 5);
    EXPECT_NEAR(checks[0].area, 3.2, 1e-3);
    EXPECT_NEAR(checks[0].points, 130 * 104, 600);
    EXPECT_LT(checks[0].angle_deg, 1e-3);
    EXPECT_LT(checks[0].distance_m, 1e-5);
}

TEST(SurfaceCheck, MeasuresDistanceAndAngle) {
    Face face = kWall;
    face.centre.z() = 2.02;
    EXPECT_NEAR(checked(face)[0].distance_m, 0.02, 1e-5);
    face = kWall;
    face.normal = {0.01, 0, -1};
    EXPECT_NEAR(checked(face)[0].angle_deg, 0.573, 0.01);
}

TEST(SurfaceCheck, LeavesOutWhatIsNotOnThePlane) {
    Face face = kWall;
    face.centre.z() = 2.05;
    EXPECT_TRUE(checked(face).empty());
    face = kWall;
    face.centre.x() = 5;
    EXPECT_TRUE(checked(face).empty());
    SurfaceChecker nothing({});
    nothing.add(DepthImage(160, 120, 2000), camera(), Pose::Identity());
    EXPECT_TRUE(nothing.checks().empty());
}

TEST(SurfaceCheck, TakesTheTenLargest) {
    PlaneMap map;
    for (int i = 0; i < 12; ++i) {
        Face face = kWall;
        face.half_x = 0.3 + 0.05 * i;
        map.planes.push_back(map_plane(i, face));
    }
    SurfaceChecker checker(map);
    checker.add(DepthImage(160, 120, 2000), camera(), Pose::Identity());
    const auto checks = checker.checks();
    ASSERT_EQ(checks.size(), 10u);
    EXPECT_EQ(checks.front().id, 11);
    EXPECT_EQ(checks.back().id, 2);
}

}  // namespace
}  // namespace planemap::evaluation
