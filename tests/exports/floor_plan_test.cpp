// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/furniture.hpp"
#include "core/random_values.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using Json = nlohmann::json;

double ring_area(const Json& ring) {
    EXPECT_GE(ring.size(), 4u);
    EXPECT_EQ(ring.front(), ring.back()) << "closed";
    Ring points;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i)
        points.emplace_back(ring[i][0].get<double>(), ring[i][1].get<double>());
    return signed_area(points);
}

/// Of a border and its holes, which turn the other way.
double polygon_area(const Json& polygon) {
    double area = 0;
    for (const Json& ring : polygon) area += ring_area(ring);
    EXPECT_GT(ring_area(polygon[0]), 0);
    return area;
}

const Json& feature(const Json& plan, const Json& id) {
    for (const Json& f : plan["features"])
        if (f["id"] == id) return f;
    throw std::out_of_range("no feature " + id.dump());
}

/// Walls, a floor with a hole, a table of two parts, a ceiling; the ids are places in the list.
PlaneMap room(const Pose& world_from_room) {
    std::vector<scene::Rectangle> planes = scene::walls(3, 2);
    planes.push_back(scene::level(0, 0, 0, 3, 2));
    planes.back().holes = {scene::rectangle_ring(-1, -1, 0.5, 1), scene::rectangle_ring(-0.5, -0.5, 0, 0.5)};
    planes.push_back(scene::level(1, 1, 0.75, 0.5, 0.4));
    planes.push_back(scene::facing_down(scene::level(0, 0, 2.5, 3, 2)));
    planes.push_back(scene::upright(1, 0.6, 0, 0.5, 0.8, 0.7));
    planes.push_back(planes.back());
    PlaneMap map = scene::map_of(planes, world_from_room);
    map.planes[5].outline = MapOutline(
        Outline{{scene::rectangle_ring(-0.5, -0.4, -0.1, 0.4), scene::rectangle_ring(0.1, -0.4, 0.5, 0.4)}});
    for (std::size_t i = 0; i < 4; ++i) map.planes[i].label = PlaneLabel::kWall;
    map.planes[4].label = PlaneLabel::kFloor;
    map.planes[5].label = PlaneLabel::kHorizontal;
    map.planes[6].label = PlaneLabel::kCeiling;
    map.planes[7].label = PlaneLabel::kOther;  // and one without a label
    map.up = world_from_room.linear().col(2).cast<float>();
    return map;
}

Trajectory walk(const Pose& world_from_room) {
    Trajectory trajectory;
    for (int i = 0; i < 6; ++i)
        trajectory.push_back({i, world_from_room * scene::looking({0.4 * i, 0, 1.4}, 0.1 * i, 0.3)});
    return trajectory;
}

TEST(FloorPlan, HasAreasLengthsAndHeightsInAnyWorld) {
    test::Random random(1);
    for (int i = 0; i < 5; ++i) {
        const Pose world_from_room = random.pose();
        const Json plan = Json::parse(floor_plan_geojson(room(world_from_room), walk(world_from_room)));
        EXPECT_EQ(plan["type"], "FeatureCollection");
        EXPECT_EQ(plan["crs"]["type"], "name");
        ASSERT_EQ(plan["features"].size(), 8u) << "no ceiling, but the trajectory";
        EXPECT_EQ(feature(plan, 7)["geometry"]["type"], "LineString");
        const Json& floor = feature(plan, 4);
        EXPECT_EQ(floor["properties"]["label"], "floor");
        ASSERT_EQ(floor["geometry"]["type"], "MultiPolygon") << "the island in the hole is a part of its own";
        double area = 0;
        for (const Json& polygon : floor["geometry"]["coordinates"]) area += polygon_area(polygon);
        EXPECT_NEAR(area, 24 - 3 + 0.5, 0.02);
        EXPECT_NEAR(floor["properties"]["high_m"], 0, 0.002);
        const Json& table = feature(plan, 5);
        EXPECT_EQ(table["geometry"]["coordinates"].size(), 2u);
        EXPECT_NEAR(table["properties"]["low_m"], 0.75, 0.002);
        const Json& wall = feature(plan, 0);
        EXPECT_EQ(wall["geometry"]["type"], "LineString");
        const auto from = wall["geometry"]["coordinates"][0].get<std::vector<double>>(),
                   to = wall["geometry"]["coordinates"][1].get<std::vector<double>>();
        EXPECT_NEAR(std::hypot(from[0] - to[0], from[1] - to[1]), 4, 0.003);
        EXPECT_NEAR(std::min(std::abs(from[0] - to[0]), std::abs(from[1] - to[1])), 0, 0.003)
            << "along an axis";
        EXPECT_NEAR(wall["properties"]["low_m"], 0, 0.002);
        EXPECT_NEAR(wall["properties"]["high_m"], 2.5, 0.002);
        EXPECT_EQ(feature(plan, "trajectory")["geometry"]["coordinates"].size(), 6u);
        // The way into the frame that the file tells.
        const auto rows = plan["rotation_level_from_world"].get<std::vector<std::vector<double>>>();
        const Eigen::Vector3d start = walk(world_from_room)[0].world_from_camera.translation();
        const Json& first = feature(plan, "trajectory")["geometry"]["coordinates"][0];
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_NEAR(rows[k][0] * start.x() + rows[k][1] * start.y() + rows[k][2] * start.z(),
                        first[k].get<double>(), 0.001);
        }
    }
}

TEST(FloorPlan, OfNothingAndOfNan) {
    EXPECT_TRUE(Json::parse(floor_plan_geojson({}, {}))["features"].empty());
    EXPECT_EQ(Json::parse(floor_plan_geojson({}, walk(Pose::Identity())))["features"].size(), 1u);
    EXPECT_TRUE(Json::parse(floor_plan_geojson({}, {walk(Pose::Identity())[0]}))["features"].empty())
        << "one position is no line";
    PlaneMap map = room(Pose::Identity());
    map.planes[4].center.setConstant(std::numeric_limits<float>::quiet_NaN());
    Trajectory trajectory = walk(Pose::Identity());
    trajectory[2].world_from_camera.translation().setConstant(std::numeric_limits<double>::infinity());
    const Json plan = Json::parse(floor_plan_geojson(map, trajectory));
    EXPECT_EQ(plan["features"].size(), 7u);
    EXPECT_NEAR(feature(plan, 0)["properties"]["high_m"], 2.5, 0.002)
        << "above the origin when there is no floor";
    EXPECT_EQ(feature(plan, "trajectory")["geometry"]["coordinates"].size(), 5u);
    EXPECT_EQ(floor_plan_geojson(map, trajectory), floor_plan_geojson(map, trajectory));
}

}  // namespace
}  // namespace planemap::exports
