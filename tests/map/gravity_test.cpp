// SPDX-License-Identifier: BSD-3-Clause
#include "map/gravity.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/furniture.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

using scene::kDegree;
using scene::Rectangle;

/// Angle between what is found and the true up, degrees.
double error_deg(const std::vector<Rectangle>& room, const std::vector<Pose>& poses,
                 const Pose& world_from_room = Pose::Identity()) {
    const auto up =
        find_up(scene::map_of(room, world_from_room).planes, scene::moved(world_from_room, poses));
    if (!up) return std::numeric_limits<double>::infinity();
    return angle_between(*up, world_from_room.linear().col(2)) / kDegree;
}

std::vector<Rectangle> room() {
    std::vector<Rectangle> planes = scene::walls(3, 2);
    planes.push_back(scene::level(0, 0, 0, 3, 2));
    return planes;
}

std::vector<Pose> straight_ahead(double length, double pitch) {
    std::vector<Pose> poses;
    for (int i = 0; i <= 10; ++i) poses.push_back(scene::looking({length * i / 10, 0, 1.2}, 0, pitch));
    return poses;
}

TEST(FindUp, InAnyWorldAndForAnyPitch) {
    test::Random random(3);
    for (int i = 0; i < 20; ++i) {
        const double pitch = random.uniform(-30, 60) * kDegree;
        EXPECT_LT(error_deg(room(), scene::looking_around(1.4, pitch), random.pose()), 0.1) << pitch;
    }
}

TEST(FindUp, WithoutAFloor) {
    for (const double pitch : {0.0, 40 * kDegree})
        EXPECT_LT(error_deg(scene::walls(3, 2), scene::looking_around(1.4, pitch)), 0.1);
    // One wall leaves a turn about its normal open, which the cameras decide.
    EXPECT_LT(error_deg({scene::walls(3, 2)[0]}, scene::looking_around(1.4, 30 * kDegree)), 1.0);
}

TEST(FindUp, OfATableOnly) {
    EXPECT_LT(error_deg({scene::level(1, 0, 0.75, 0.6, 0.4)}, {scene::looking({0, 0, 1.4}, 0, 35 * kDegree)}),
              0.1);
}

TEST(FindUp, SaysNothingWhenItCannotTell) {
    const std::vector<Pose> one_look = {scene::looking({0, 0, 1.2}, 0, 45 * kDegree)};
    EXPECT_FALSE(find_up(scene::map_of(room()).planes, one_look)) << "the floor may be the wall ahead";
    EXPECT_FALSE(find_up({}, one_look));
    EXPECT_FALSE(find_up(scene::map_of(room()).planes, {}));
}

TEST(FindUp, ByTheMotionOfARobotThatLooksDown) {
    EXPECT_LT(error_deg(room(), straight_ahead(4, 50 * kDegree)), 0.1);
    EXPECT_EQ(error_deg(room(), straight_ahead(0.3, 50 * kDegree)), std::numeric_limits<double>::infinity());
}

TEST(FindUp, NoSinglePlaneDecides) {
    std::vector<Rectangle> planes = room();
    for (const double x : {-2.0, -1.0, 1.0, 2.0}) planes.push_back(scene::level(x, 1, 0.8, 0.6, 0.5));
    // The floor, by far the largest, is 4 deg off: a drift, or a real slope.
    planes[4].world_from_face =
        planes[4].world_from_face * Eigen::AngleAxisd(4 * kDegree, Eigen::Vector3d::UnitX());
    EXPECT_LT(error_deg(planes, scene::looking_around(1.4, 20 * kDegree)), 1.5);
    // So far off, it is none.
    planes[4].world_from_face =
        planes[4].world_from_face * Eigen::AngleAxisd(14 * kDegree, Eigen::Vector3d::UnitX());
    EXPECT_LT(error_deg(planes, scene::looking_around(1.4, 20 * kDegree)), 0.1);
}

TEST(FindUp, WithNoiseOnAllNormals) {
    test::Random random(5);
    for (int i = 0; i < 20; ++i) {
        std::vector<Rectangle> planes = room();
        for (Rectangle& r : planes) r.world_from_face.rotate(so3_exp(0.5 * kDegree * random.direction()));
        EXPECT_LT(error_deg(planes, scene::looking_around(1.4, 30 * kDegree)), 0.7);
    }
}

TEST(FindUp, LeavesOutWhatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    PlaneMap map = scene::map_of(room());
    map.planes[0].normal.setConstant(nan);
    map.planes[1].area = nan;
    map.planes[2].normal.setZero();
    std::vector<Pose> poses = scene::looking_around(1.4, 20 * kDegree);
    poses[3].translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    const auto up = find_up(map.planes, poses);
    ASSERT_TRUE(up);
    EXPECT_LT((*up - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
    for (MapPlane& plane : map.planes) plane.area = nan;
    EXPECT_FALSE(find_up(map.planes, poses));
}

}  // namespace
}  // namespace planemap::map
