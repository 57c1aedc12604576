// SPDX-License-Identifier: BSD-3-Clause
#include "map/intersections.hpp"

#include <gtest/gtest.h>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;

const AdjacencyRules kRules{0.15, kParallel_rad, 0.15, 0.04};

PlaneShape plane_of(int id, const Rectangle& rectangle) {
    return PlaneShape(MapPlane(id, scene::region_of(rectangle, Pose::Identity()), 1));
}

// A corner at (1, 1, 0): floor z = 0, walls x = 1 and y = 1.
const Rectangle kFloor{facing({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 1, 1, {}};
const Rectangle kWallX{facing({1, 0, 1}, {-1, 0, 0}, {0, 1, 0}), 1, 1, {}};
const Rectangle kWallY{facing({0, 1, 1}, {0, -1, 0}, {1, 0, 0}), 1, 1, {}};

TEST(Intersections, OfARoomsCorner) {
    const PlaneShape floor = plane_of(4, kFloor), wall_x = plane_of(2, kWallX), wall_y = plane_of(7, kWallY);
    const auto lines = intersection_lines(floor, wall_x, kRules);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].plane_a, 2);
    EXPECT_EQ(lines[0].plane_b, 4);
    for (const auto& end : {lines[0].from, lines[0].to}) {
        EXPECT_NEAR(end.x(), 1, 1e-6);
        EXPECT_NEAR(std::abs(end.y()), 1, 1e-6);
        EXPECT_NEAR(end.z(), 0, 1e-6);
    }
    const auto point = intersection_point(floor, wall_y, wall_x, kRules);
    ASSERT_TRUE(point);
    EXPECT_EQ(point->planes, (std::array<int, 3>{2, 4, 7}));
    EXPECT_NEAR((point->position - Eigen::Vector3f(1, 1, 0)).norm(), 0, 1e-6);
}

TEST(Intersections, AreCutToWhereBothAre) {
    // A short wall on a long floor.
    Rectangle wall = kWallX;
    wall.half_x = 0.3;
    const auto lines = intersection_lines(plane_of(1, kFloor), plane_of(2, wall), kRules);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NEAR((lines[0].to - lines[0].from).norm(), 0.6, 1e-6);
}

TEST(Intersections, BreakAtADoor) {
    // The door reaches from the floor up, 0.8 m wide.
    Rectangle wall = kWallX;
    PlaneShape with_door = plane_of(2, wall);
    Outline outline{
        {Ring{{-1, -1}, {-0.4, -1}, {-0.4, 0.9}, {0.4, 0.9}, {0.4, -1}, {1, -1}, {1, 1}, {-1, 1}}}};
    const Pose flip = facing({1, 0, 1}, {-1, 0, 0}, {0, 1, 0});
    // The face's y axis points down for this wall; put the door's foot on the floor.
    if (flip.linear().col(1).z() < 0)
        for (auto& v : outline.rings[0]) v.y() = -v.y();
    with_door.outline = outline;
    const auto lines = intersection_lines(plane_of(1, kFloor), with_door, kRules);
    ASSERT_EQ(lines.size(), 2u);
    for (const auto& line : lines) EXPECT_NEAR((line.to - line.from).norm(), 0.6, 1e-6);
}

TEST(Intersections, NeedAdjacency) {
    Rectangle far = kWallX;
    far.world_from_face.translation() += Eigen::Vector3d(0.2, 0, 0);
    EXPECT_TRUE(intersection_lines(plane_of(1, kFloor), plane_of(2, far), kRules).empty());
    Rectangle near = kWallX;
    near.world_from_face.translation() += Eigen::Vector3d(0.08, 0, 0.08);
    EXPECT_EQ(intersection_lines(plane_of(1, kFloor), plane_of(2, near), kRules).size(), 1u);
    Rectangle high = kWallX;
    high.world_from_face.translation().z() += 0.5;
    EXPECT_TRUE(intersection_lines(plane_of(1, kFloor), plane_of(2, high), kRules).empty());
    EXPECT_FALSE(intersection_point(plane_of(1, kFloor), plane_of(2, kWallY), plane_of(3, high), kRules));
}

TEST(Intersections, PlanesReachTheirLineAsFarAsReadingsAreNoisy) {
    EXPECT_NEAR(meeting_reach(0, 0, 1, kRules), kRules.slack_m, 1e-9);
    EXPECT_NEAR(meeting_reach(0.003, 0.004, 1, kRules), kRules.slack_m + 0.015, 1e-9);
    EXPECT_NEAR(meeting_reach(0.003, 0.004, 0.5, kRules), kRules.slack_m + 0.03, 1e-9)
        << "a flat pair's line is less sure";
    EXPECT_NEAR(meeting_reach(0.003, 0.004, 1e-9, kRules), kRules.gap_m, 1e-9) << "however noisy";
}

TEST(Intersections, ParallelAndFlatPairsHaveNone) {
    Rectangle table = kFloor;
    table.world_from_face.translation().z() = 0.05;
    EXPECT_TRUE(intersection_lines(plane_of(1, kFloor), plane_of(2, table), kRules).empty());
    const Rectangle ramp{facing({0, 0, 0}, {0.1, 0, 1}, {1, 0, 0}), 1, 1, {}};
    EXPECT_TRUE(intersection_lines(plane_of(1, kFloor), plane_of(2, ramp), kRules).empty());
    EXPECT_TRUE(intersection_lines(plane_of(1, kFloor), plane_of(2, kFloor), kRules).empty());
    EXPECT_FALSE(intersection_point(plane_of(1, kFloor), plane_of(2, kFloor), plane_of(3, kWallX), kRules));
}

TEST(Intersections, CrossingPlanesMeetInside) {
    const Rectangle upright{facing({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.5, 0.5, {}};
    const auto lines = intersection_lines(plane_of(1, kFloor), plane_of(2, upright), kRules);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NEAR((lines[0].to - lines[0].from).norm(), 1, 1e-6);
}

}  // namespace
}  // namespace planemap::map
