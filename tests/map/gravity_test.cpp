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
    const std::optional<Eigen::Vector3d> up =
        find_up(scene::map_of(room, world_from_room).planes, scene::moved(world_from_room, poses)).direction;
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
    const Up up = find_up(scene::map_of(room()).planes, one_look);
    EXPECT_FALSE(up.direction) << "the floor may be the wall ahead";
    EXPECT_NE(up.why.find("90 deg apart"), std::string::npos) << up.why;
    EXPECT_EQ(find_up({}, one_look).why, "there are no planes");
    EXPECT_EQ(find_up(scene::map_of(room()).planes, {}).why, "no keyframe has a pose");
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

/// The same poses of a camera that is turned about its optical axis.
std::vector<Pose> rolled(std::vector<Pose> poses, double angle) {
    for (Pose& pose : poses) pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    return poses;
}

std::vector<Rectangle> furnished() {
    std::vector<Rectangle> planes = room();
    planes.push_back(scene::facing_down(scene::level(0, 0, 2.5, 3, 2)));
    for (const double x : {-2, 0, 2}) {
        planes.push_back(scene::level(x, 1, 0.75, 0.8, 0.5));
        planes.push_back(scene::upright(x, -1.4, 0, 90 * kDegree, 1.2, 0.9));
        planes.push_back(scene::level(x, -1.7, 0.9, 0.6, 0.3));
    }
    return planes;
}

TEST(FindUp, OfACameraHeldOnItsSideOrUpsideDown) {
    test::Random random(7);
    for (const double roll : {90, 180, 270, 45})
        EXPECT_LT(error_deg(furnished(), rolled(scene::looking_around(1.4, 10 * kDegree), roll * kDegree),
                            random.pose()),
                  0.1)
            << roll;
}

TEST(FindUp, OfACameraThatLooksStraightDown) {
    // Over a floor with a table and boxes, along it, hardly turning: no wall has a table's top before it with
    // nothing beneath.
    const std::vector<Rectangle> planes{scene::level(0, 0, 0, 2, 1.5), scene::level(0.3, 0, 0.74, 0.7, 0.4),
                                        scene::level(-1, 0.5, 0.25, 0.3, 0.3),
                                        scene::level(1.2, -0.6, 0.12, 0.3, 0.2)};
    std::vector<Pose> poses;
    for (int i = 0; i < 4; ++i)
        poses.push_back(scene::looking({-0.6 + 0.4 * i, 0.05 * i, 2.6}, 90 * kDegree, 90 * kDegree));
    EXPECT_LT(error_deg(planes, poses), 0.1);
}

TEST(FindUp, OfADeskBeforeAFloorOnADownwardLook) {
    std::vector<Rectangle> planes{scene::level(2, 0, 0, 1.5, 1.5), scene::level(1.2, 0, 0.73, 0.4, 0.8),
                                  scene::upright(1.5, 0, 0.75, 180 * kDegree, 0.5, 0.4)};
    EXPECT_LT(error_deg(planes, {scene::looking({0, 0, 1.4}, 0, 40 * kDegree)}), 0.1);
}

TEST(FindUp, AGhostThatWasSeenOnceTurnsNothing) {
    PlaneMap map = scene::map_of(room());
    Rectangle ghost = scene::level(0, 0, -1, 4, 4);
    ghost.world_from_face.rotate(Eigen::AngleAxisd(7 * kDegree, Eigen::Vector3d::UnitX()));
    map.planes.emplace_back(9, scene::region_of(ghost, Pose::Identity(), 0.1), 1);
    for (MapPlane& plane : map.planes) plane.keyframes = plane.id == 9 ? 1 : 30;
    const auto up = find_up(map.planes, scene::looking_around(1.4, 20 * kDegree)).direction;
    ASSERT_TRUE(up);
    EXPECT_LT(angle_between(*up, Eigen::Vector3d::UnitZ()) / kDegree, 1.0);
}

TEST(UpAsTold, IsMadeExactByThePlanes) {
    const std::vector<Eigen::Vector3d> told(5, Eigen::Vector3d(0.05, 0, 1).normalized());
    const Up up = up_as_told(told, scene::map_of(room()).planes, "the mount");
    ASSERT_TRUE(up.direction);
    EXPECT_LT(angle_between(*up.direction, Eigen::Vector3d::UnitZ()) / kDegree, 0.5);
    EXPECT_EQ(up.why, "by the mount");
    const Up alone = up_as_told(told, {}, "the mount");
    ASSERT_TRUE(alone.direction);
    EXPECT_LT(angle_between(*alone.direction, told[0]), 1e-9) << "without planes it stands";
}

TEST(UpAsTold, IsNotKnownWhenTheDirectionsScatter) {
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    const Up up = up_as_told(std::vector<Eigen::Vector3d>{z, Eigen::Vector3d::UnitX()}, {}, "the mount");
    EXPECT_FALSE(up.direction);
    EXPECT_EQ(up.why, "the mount says another direction each time (they scatter by 45 deg in the world)");
    EXPECT_FALSE(up_as_told({}, {}, "the mount").direction);
    EXPECT_TRUE(up_as_told(std::vector<Eigen::Vector3d>{z, z * std::nan("")}, {}, "the mount").direction);
}

TEST(FindUp, LeavesOutWhatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    PlaneMap map = scene::map_of(room());
    map.planes[0].normal.setConstant(nan);
    map.planes[1].area = nan;
    map.planes[2].normal.setZero();
    std::vector<Pose> poses = scene::looking_around(1.4, 20 * kDegree);
    poses[3].translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    const auto up = find_up(map.planes, poses).direction;
    ASSERT_TRUE(up);
    EXPECT_LT((*up - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
    for (MapPlane& plane : map.planes) plane.area = nan;
    EXPECT_FALSE(find_up(map.planes, poses).direction);
}

}  // namespace
}  // namespace planemap::map
