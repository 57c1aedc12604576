// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_intersections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/furniture.hpp"

namespace planemap::map {
namespace {

const AdjacencyRules kRules{0.15, 0.26, 0.25, 0.15};

/// Four walls, a floor and a table in the middle.
PlaneMap room() {
    std::vector<scene::Rectangle> planes = scene::walls(2, 1.5);
    planes.push_back(scene::level(0, 0, 0, 2, 1.5));
    planes.push_back(scene::level(0, 0, 0.75, 0.4, 0.3));
    return scene::map_of(planes);
}

std::vector<int> ids_of(const PlaneMap& map) {
    std::vector<int> ids;
    for (const MapPlane& plane : map.planes) ids.push_back(plane.id);
    return ids;
}

void expect_same(const PlaneMap& a, const PlaneMap& b) {
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t i = 0; i < a.lines.size(); ++i) {
        EXPECT_EQ(a.lines[i].plane_a, b.lines[i].plane_a);
        EXPECT_EQ(a.lines[i].plane_b, b.lines[i].plane_b);
        EXPECT_EQ(a.lines[i].from, b.lines[i].from);
        EXPECT_EQ(a.lines[i].to, b.lines[i].to);
    }
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i].position, b.points[i].position);
}

TEST(MapIntersections, OfARoom) {
    PlaneMap map = room();
    MapIntersections(kRules).update(map, ids_of(map));
    EXPECT_EQ(map.lines.size(), 8u) << "four walls in a ring, each on the floor";
    EXPECT_EQ(map.points.size(), 4u);
}

TEST(MapIntersections, StepByStepAreThoseOfAllAtOnce) {
    PlaneMap at_once = room(), stepwise;
    MapIntersections all(kRules), steps(kRules);
    all.update(at_once, ids_of(at_once));
    for (const std::size_t i : {3u, 0u, 5u, 1u, 4u, 2u}) {
        const MapPlane& plane = at_once.planes[i];
        const auto place = std::find_if(stepwise.planes.begin(), stepwise.planes.end(),
                                        [&](const MapPlane& p) { return p.id > plane.id; });
        stepwise.planes.insert(place, plane);
        steps.update(stepwise, {plane.id});
    }
    expect_same(stepwise, at_once);
}

TEST(MapIntersections, GoWithTheirPlanesAndFollowThem) {
    PlaneMap map = room();
    MapIntersections intersections(kRules);
    intersections.update(map, ids_of(map));
    const int floor = 4;
    MapPlane& plane = map.planes[floor];
    Plane lower = plane.plane();
    lower.d += 0.05;
    plane.move_to(lower);
    intersections.update(map, {floor});
    for (const IntersectionPoint& point : map.points) EXPECT_NEAR(point.position.z(), -0.05, 1e-3);
    EXPECT_NEAR(intersections.plane(floor)->d, lower.d, 1e-6);
    PlaneMap fresh = map;
    fresh.lines.clear();
    fresh.points.clear();
    MapIntersections(kRules).update(fresh, ids_of(fresh));
    expect_same(map, fresh);
    map.planes.erase(map.planes.begin() + floor);
    intersections.update(map, {floor});
    EXPECT_EQ(map.lines.size(), 4u);
    EXPECT_TRUE(map.points.empty());
    EXPECT_EQ(intersections.plane(floor), nullptr);
}

TEST(MapIntersections, LinesEndWhereThreePlanesMeet) {
    std::vector<scene::Rectangle> planes = scene::walls(2, 1.5);
    planes.push_back(scene::level(0, 0, 0, 1.9, 1.4));  // the floor is seen up to 10 cm before the walls
    PlaneMap map = scene::map_of(planes);
    MapIntersections(kRules).update(map, ids_of(map));
    EXPECT_EQ(map.points.size(), 4u);
    for (const IntersectionLine& line : map.lines) {
        if (line.plane_b != 4) continue;
        for (const Eigen::Vector3f& end : {line.from, line.to})
            EXPECT_TRUE(std::any_of(map.points.begin(), map.points.end(), [&](const auto& point) {
                return (point.position - end).norm() < 1e-5f;
            }));
    }
}

TEST(MapIntersections, OfNothing) {
    PlaneMap map;
    MapIntersections intersections(kRules);
    intersections.update(map, {});
    intersections.update(map, {1, 2});
    EXPECT_TRUE(map.lines.empty() && map.points.empty());
    EXPECT_FALSE(intersections.left_out_points());
    EXPECT_EQ(intersections.memory_bytes(), 0u);
}

}  // namespace
}  // namespace planemap::map
