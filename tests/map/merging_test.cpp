// SPDX-License-Identifier: BSD-3-Clause
#include "map/merging.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;

const MergeRules kRules{radians(10), 0.05, 0.5};

struct Sheet {
    Plane plane;
    Box box;
};

Sheet sheet(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, double half_x, double half_y) {
    Sheet s;
    s.box.frame_from_box = facing(centre, normal, {1, 0, 0});
    s.box.half_extents = {half_x, half_y, 0.01};
    s.plane = {normal.normalized(), -normal.normalized().dot(centre)};
    return s;
}

bool same(const Sheet& a, const Sheet& b) {
    const bool forth = same_plane(a.plane, a.box, b.plane, b.box, kRules).has_value();
    EXPECT_EQ(forth, same_plane(b.plane, b.box, a.plane, a.box, kRules).has_value()) << "not symmetric";
    return forth;
}

Eigen::Vector3d tilted(double deg) {
    return {std::sin(radians(deg)), 0, std::cos(radians(deg))};
}

TEST(Merging, AngleThreshold) {
    const Sheet a = sheet({0, 0, 2}, {0, 0, 1}, 0.3, 0.3);
    EXPECT_TRUE(same(a, sheet({0, 0, 2}, tilted(9.9), 0.3, 0.3)));
    EXPECT_FALSE(same(a, sheet({0, 0, 2}, tilted(10.1), 0.3, 0.3)));
}

TEST(Merging, DistanceThreshold) {
    const Sheet a = sheet({0, 0, 2}, {0, 0, 1}, 1, 1);
    EXPECT_TRUE(same(a, sheet({0.5, 0, 2.049}, {0, 0, 1}, 1, 1)));
    EXPECT_FALSE(same(a, sheet({0.5, 0, 2.051}, {0, 0, 1}, 1, 1)));
}

TEST(Merging, GapThreshold) {
    const Sheet a = sheet({0, 0, 2}, {0, 0, 1}, 1, 1);
    EXPECT_TRUE(same(a, sheet({2.49, 0, 2}, {0, 0, 1}, 1, 1)));
    EXPECT_FALSE(same(a, sheet({2.51, 0, 2}, {0, 0, 1}, 1, 1)));
    EXPECT_TRUE(same(a, sheet({2, 2, 2}, {0, 0, 1}, 1, 1))) << "boxes that touch at a corner";
}

TEST(Merging, DistanceIsMeasuredWhereTheRegionsAre) {
    // Ten metres from the origin, 2 deg turn the plane's distance to the origin by 35 cm.
    const Eigen::Vector3d away(10, 0, 0);
    EXPECT_TRUE(same(sheet(away, {0, 0, 1}, 0.5, 0.5), sheet(away, tilted(2), 0.5, 0.5)));
    // A small noisy patch on a large wall, far from the wall's centre.
    EXPECT_TRUE(same(sheet({0, 0, 0}, {0, 0, 1}, 4, 1.3), sheet({3.5, 0, 0.02}, tilted(8), 0.2, 0.2)));
    // A patch whose plane passes through the wall's centre while it lies 30 cm in front of the wall.
    EXPECT_FALSE(same(sheet({0, 0, 0}, {0, 0, 1}, 4, 1.3), sheet({3.5, 0, -0.3}, tilted(4.9), 0.2, 0.2)));
    // Large planes that cross at their centres are not one.
    EXPECT_FALSE(same(sheet({0, 0, 0}, {0, 0, 1}, 2, 2), sheet({0, 0, 0}, tilted(8), 2, 2)));
}

TEST(Merging, TheTwoSidesOfAWallAreTwoPlanes) {
    EXPECT_FALSE(same(sheet({0, 0, 2}, {0, 0, 1}, 1, 1), sheet({0, 0, 2}, {0, 0, -1}, 1, 1)));
}

TEST(Merging, IsInvariantUnderRigidMotion) {
    const Pose move = make_pose({3, -7, 2}, Eigen::Quaterniond(0.3, 0.5, -0.2, 0.7).normalized());
    const Sheet a = sheet({0, 0, 2}, {0, 0, 1}, 1, 0.5), b = sheet({0.8, 0.3, 2.02}, tilted(3), 0.7, 0.6);
    const RegionRelation before = relate(a.plane, a.box, b.plane, b.box);
    const RegionRelation after = relate(move * a.plane, move * a.box, move * b.plane, move * b.box);
    EXPECT_NEAR(before.angle_rad, after.angle_rad, 1e-9);
    EXPECT_NEAR(before.distance_m, after.distance_m, 1e-9);
    EXPECT_NEAR(before.gap_m, after.gap_m, 1e-9);
    EXPECT_NEAR(before.distance_m, relate(b.plane, b.box, a.plane, a.box).distance_m, 1e-9);
}

TEST(Merging, BoxesWithoutExtentAreCompared) {
    const Sheet point = sheet({0, 0, 2}, {0, 0, 1}, 0, 0);
    EXPECT_TRUE(same(point, point));
    EXPECT_TRUE(same(point, sheet({0.2, 0, 2.01}, {0, 0, 1}, 0, 0)));
    EXPECT_FALSE(same(point, sheet({0.2, 0, 2.1}, {0, 0, 1}, 0, 0)));
}

}  // namespace
}  // namespace planemap::map
