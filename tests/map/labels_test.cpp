// SPDX-License-Identifier: BSD-3-Clause
#include "map/labels.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/furniture.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

using scene::facing_down;
using scene::kDegree;
using scene::level;
using scene::Rectangle;
using scene::upright;

/// First letters of the labels, in the order of the planes.
std::string labels(const PlaneMap& map) {
    std::string text;
    for (const MapPlane& plane : map.planes) text += label_name(plane.label)[0];
    return text;
}

PlaneMap named(const std::vector<Rectangle>& room, const std::vector<Pose>& poses,
               const Pose& world_from_room = Pose::Identity()) {
    PlaneMap map = scene::map_of(room, world_from_room);
    label_planes(map, scene::moved(world_from_room, poses));
    return map;
}

std::vector<Rectangle> operator+(std::vector<Rectangle> a, const std::vector<Rectangle>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Four walls, floor, ceiling, table, seat, cabinet side, tall cupboard, ramp, lamp, underside of the table.
std::vector<Rectangle> furnished() {
    Rectangle ramp = level(-1.5, -1, 0.4, 0.6, 0.4);
    ramp.world_from_face = ramp.world_from_face * Eigen::AngleAxisd(30 * kDegree, Eigen::Vector3d::UnitX());
    return scene::walls(3, 2) + std::vector<Rectangle>{level(0, 0, 0, 3, 2),
                                                       facing_down(level(0, 0, 2.5, 3, 2)),
                                                       level(1, 1, 0.75, 0.8, 0.5),
                                                       level(-1, 1, 0.45, 0.2, 0.2),
                                                       upright(2, -1, 0, 0.3, 0.6, 0.8),
                                                       upright(-2, 1.8, 0, -1.4, 1, 2),
                                                       ramp,
                                                       facing_down(level(0, 0, 2.2, 0.3, 0.3)),
                                                       facing_down(level(1, 1, 0.72, 0.8, 0.5))};
}
constexpr const char* kFurnished = "wwwwfchhvvohh";

TEST(LabelPlanes, OfAFurnishedRoomInAnyWorldAndAtAnyPitch) {
    test::Random random(1);
    for (int i = 0; i < 20; ++i) {
        const Pose world_from_room = random.pose();
        const double pitch = random.uniform(-20, 45) * kDegree;
        const PlaneMap map = named(furnished(), scene::looking_around(1.4, pitch), world_from_room);
        EXPECT_EQ(labels(map), kFurnished) << pitch;
        EXPECT_LT((map.up.cast<double>() - world_from_room.linear().col(2)).norm(), 0.01);
        EXPECT_NEAR(map.up.norm(), 1, 1e-6);
    }
}

TEST(LabelPlanes, GivesTheSameTwice) {
    PlaneMap a = named(furnished(), scene::looking_around(1.4, 0.5)), b = a;
    label_planes(b, scene::looking_around(1.4, 0.5));
    EXPECT_EQ(labels(a), labels(b));
    EXPECT_EQ(a.up, b.up);
    label_planes(b, {});
    EXPECT_EQ(labels(b), std::string(b.planes.size(), 'u')) << "earlier names are not kept";
}

TEST(LabelPlanes, FloorInPiecesAndAtTwoHeights) {
    const std::vector<Rectangle> room =
        scene::walls(6, 2) + std::vector<Rectangle>{level(-4, 0, 0, 2, 2), level(2, 0, 0.04, 2, 2),
                                                    level(5, 0, -0.06, 0.3, 0.3), level(0, 1, 0.2, 0.4, 0.4)};
    EXPECT_EQ(labels(named(room, scene::looking_around(1.4, 0.4))), "wwwwfffh");
}

TEST(LabelPlanes, ALongFloorThatTiltsIsOneFloor) {
    // Drift: the further piece is in the plane of the nearer one, 35 cm lower.
    Pose tilted = Pose::Identity();
    tilted.rotate(Eigen::AngleAxisd(1 * kDegree, Eigen::Vector3d::UnitY()));
    std::vector<Rectangle> floors = {level(0, 0, 0, 5, 2), level(20, 0, 0, 4, 2)};
    for (Rectangle& r : floors) r.world_from_face = tilted * r.world_from_face;
    EXPECT_EQ(labels(named(scene::walls(25, 2) + floors, scene::looking_around(1.4, 0.4))), "wwwwff");
}

TEST(LabelPlanes, WithoutAFloorATableIsNone) {
    const std::vector<Pose> poses = scene::looking_around(1.4, 0.4);
    const Rectangle table = level(1, 0, 0.75, 0.8, 0.5);
    EXPECT_EQ(labels(named({table}, poses)), "h");
    EXPECT_EQ(labels(named(scene::walls(3, 2) + std::vector<Rectangle>{table}, poses)), "wwwwh");
    const Rectangle conference_table = level(1, 0, 0.75, 2, 1);
    EXPECT_EQ(labels(named(scene::walls(3, 2) + std::vector<Rectangle>{conference_table}, poses)), "wwwwh")
        << "walls go on below it";
    EXPECT_EQ(labels(named({table, level(0, 1, 0, 0.5, 0.5)}, poses)), "hf") << "a little of the floor";
}

TEST(LabelPlanes, WithoutAFloorThereAreWallsAndACeiling) {
    EXPECT_EQ(
        labels(named(scene::walls(3, 2) + std::vector<Rectangle>{facing_down(level(0, 0, 2.5, 3, 2)),
                                                                 facing_down(level(1, 1, 0.72, 0.8, 0.8))},
                     scene::looking_around(1.4, 0.3))),
        "wwwwch");
}

TEST(LabelPlanes, FromAsLowAsARobot) {
    // Its camera sees the underside of a table from below; that is no ceiling, with the walls above it.
    const std::vector<Pose> poses = scene::looking_around(0.3, 0.1);
    const Rectangle under = facing_down(level(1, 1, 0.72, 1, 0.8));
    EXPECT_EQ(labels(named(scene::walls(3, 2) + std::vector<Rectangle>{level(0, 0, 0, 3, 2), under}, poses)),
              "wwwwfh");
    EXPECT_EQ(labels(named(scene::walls(3, 2) + std::vector<Rectangle>{under}, poses)), "wwwwh");
}

TEST(LabelPlanes, TwoStoreysAndStairs) {
    std::vector<Rectangle> house = scene::walls(4, 3, 0, 2.5) + scene::walls(4, 3, 2.8, 2.4);
    house = house + std::vector<Rectangle>{level(-1, 0, 0, 3, 3), facing_down(level(-1, 0, 2.5, 3, 3)),
                                           level(-1, 0, 2.8, 3, 3), facing_down(level(0, 0, 5.2, 4, 3)),
                                           level(-2, 1, 3.55, 1, 0.5)};
    for (int step = 1; step < 16; ++step)
        house.push_back(level(2.5 + 0.02 * step, 0, 0.175 * step, 0.14, 0.5));
    std::vector<Pose> poses = scene::looking_around(1.4, 0.3);
    for (const Pose& pose : scene::looking_around(4.2, 0.3)) poses.push_back(pose);
    EXPECT_EQ(labels(named(house, poses)), "wwwwwwwwfcfch" + std::string(15, 'h'));
    // Who was never upstairs does not know that one can stand there.
    const std::string from_below = labels(named(house, scene::looking_around(1.4, 0.3)));
    EXPECT_EQ(from_below[8], 'f');
    EXPECT_EQ(from_below[10], 'h');
}

TEST(LabelPlanes, AFewCentimetresOfAMirrorBelowTheFloorDoNotMatter) {
    EXPECT_EQ(labels(named(furnished() + std::vector<Rectangle>{level(0, 1, -0.8, 0.4, 0.4)},
                           scene::looking_around(1.4, 0.3))),
              std::string(kFurnished) + "h");
}

/// Each plane seen by so many keyframes.
PlaneMap seen_by(const std::vector<Rectangle>& room, const std::vector<int>& keyframes) {
    PlaneMap map = scene::map_of(room);
    for (std::size_t i = 0; i < keyframes.size(); ++i)
        map.planes[i].keyframes = static_cast<std::int16_t>(keyframes[i]);
    return map;
}

TEST(LabelPlanes, AGhostBelowTheFloorThatOneLookSawIsNoFloor) {
    std::vector<Rectangle> planes = scene::walls(6, 4);
    planes.push_back(level(0, 0, 0, 6, 3));
    planes.push_back(level(0, 0, -1.5, 1.8, 1));
    PlaneMap map = seen_by(planes, {5, 5, 5, 5, 39, 1});
    label_planes(map, scene::looking_around(0.3, 0.1));
    EXPECT_EQ(labels(map), "wwwwfh");
}

TEST(LabelPlanes, TwoLevelsAStepApartAreBothFloors) {
    const std::vector<Rectangle> planes =
        scene::walls(4, 3) + std::vector<Rectangle>{level(-3, 0, 0, 0.4, 1.6), level(1, 0, 0.18, 3, 2.5),
                                                    upright(-2, 0, 0, 180 * kDegree, 2.5, 0.18),
                                                    level(2, 1, 0.45, 0.5, 0.3)};
    EXPECT_EQ(labels(named(planes, scene::looking_around(1.5, 0.4))), "wwwwffvh");
}

TEST(LabelPlanes, ACeilingThatHangsLowerInPartIsOneAndALampIsNot) {
    const std::vector<Rectangle> planes =
        scene::walls(3, 2) + std::vector<Rectangle>{level(0, 0, 0, 3, 2),
                                                    facing_down(level(-1, 0, 2.5, 2, 2)),
                                                    facing_down(level(2, 0, 2.25, 1, 2)),
                                                    facing_down(level(0, 0, 2.1, 0.3, 0.3)),
                                                    level(1, 1, 0.75, 0.8, 0.5),
                                                    level(-1, 1, 0.75, 0.8, 0.5)};
    EXPECT_EQ(labels(named(planes, scene::looking_around(1.4, 0.1))), "wwwwfcchhh");
}

TEST(LabelPlanes, TheLowestShelfIsNotAPieceOfTheFloor) {
    const std::vector<Rectangle> planes =
        scene::walls(3, 2) + std::vector<Rectangle>{level(0, 0, 0, 2, 2), level(-2.5, 0, 0.08, 0.2, 0.12)};
    EXPECT_EQ(labels(named(planes, scene::looking_around(1.4, 0.4))), "wwwwfh");
}

TEST(LabelPlanes, AFaceIsFurnitureWhereTheWallIsSeenOverItOrATopGoesBackFromIt) {
    const double facing = 90 * kDegree;  // as the wall at y = -2 does
    const auto of = [&](const std::vector<Rectangle>& things) {
        return labels(named(scene::walls(3, 2) + std::vector<Rectangle>{level(0, 0, 0, 3, 2)} + things,
                            scene::looking_around(1.4, 0.3)))
            .substr(5);
    };
    EXPECT_EQ(of({upright(1, -1.4, 0, facing, 1, 2.1)}), "v") << "a tall cupboard";
    EXPECT_EQ(of({upright(1, -1.4, 0, facing, 1, 2.5)}), "w") << "one as high as the wall";
    EXPECT_EQ(of({upright(1, -1.9, 0, facing, 1, 2.1)}), "w") << "a door, or the same wall a little off";
    EXPECT_EQ(of({upright(1, 0.5, 0, facing, 1.5, 1.4)}), "w") << "a partition in the room";
    EXPECT_EQ(of({upright(1, 0.5, 0, facing, 1.5, 1.4), level(1, 0.25, 1.4, 0.75, 0.25)}), "vh")
        << "a sideboard in the room";
    EXPECT_EQ(of({upright(1, 0.5, 0, facing, 0.6, 0.7)}), "v") << "a box";
    EXPECT_EQ(of({upright(1, 0.5, 0, facing, 0.4, 1.6)}), "v") << "the side of a cupboard";
}

TEST(LabelPlanes, DoNotDependOnHowTheCameraIsHeld) {
    std::vector<Rectangle> room =
        scene::walls(3, 2) +
        std::vector<Rectangle>{level(0, 0, 0, 3, 2), facing_down(level(0, 0, 2.5, 3, 2))};
    for (const double x : {-2, 0, 2})
        room = room + std::vector<Rectangle>{level(x, 1, 0.75, 0.8, 0.5),
                                             upright(x, -1.4, 0, 90 * kDegree, 1.2, 0.9),
                                             level(x, -1.7, 0.9, 0.6, 0.3)};
    test::Random random(2);
    for (const double roll : {0, 90, 180, 270}) {
        std::vector<Pose> poses = scene::looking_around(1.4, 0.3);
        for (Pose& pose : poses) pose.rotate(Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitZ()));
        EXPECT_EQ(labels(named(room, poses, random.pose())), "wwwwfchvhhvhhvh") << roll;
    }
}

TEST(LabelPlanes, OfNothing) {
    PlaneMap map;
    label_planes(map, scene::looking_around(1.4, 0));
    EXPECT_TRUE(map.up.isZero());
    map = scene::map_of(furnished());
    map.up = Eigen::Vector3f::UnitX();
    label_planes(map, {});
    EXPECT_TRUE(map.up.isZero()) << "without cameras nothing says which side is up";
    EXPECT_EQ(labels(map), std::string(map.planes.size(), 'u'));
}

TEST(LabelPlanes, LeavesOutWhatIsNotFinite) {
    PlaneMap map = scene::map_of(furnished());
    map.planes[0].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    map.planes[6].normal.setConstant(std::numeric_limits<float>::infinity());
    map.planes[7].area = std::numeric_limits<float>::quiet_NaN();
    map.planes[8].outline = {};
    map.planes[9].normal.setZero();
    std::vector<Pose> poses = scene::looking_around(1.4, 0.3);
    poses[0].translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    label_planes(map, poses);
    EXPECT_EQ(labels(map), "uwwwfcuuvuohh");
}

}  // namespace
}  // namespace planemap::map
