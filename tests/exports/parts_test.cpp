// SPDX-License-Identifier: BSD-3-Clause
#include "exports/parts.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/furniture.hpp"
#include "core/random_values.hpp"
#include "exports/corner.hpp"

namespace planemap::exports {
namespace {

TEST(Fixed, WritesDecimalsAndNoNegativeZero) {
    EXPECT_EQ(fixed(1.25, 1), "1.2");
    EXPECT_EQ(fixed(-1.5, 3), "-1.500");
    EXPECT_EQ(fixed(-0.0004, 3), "0.000");
    EXPECT_EQ(fixed(-0.0, 0), "0");
    EXPECT_EQ(fixed(12345678.9, 1), "12345678.9");
}

TEST(UpOf, IsTheMapsOrHowTheCameraWasHeld) {
    PlaneMap map = scene::corner();
    map.up = Eigen::Vector3f(0, 1, 0);
    EXPECT_EQ(up_of(map, scene::walk()), Eigen::Vector3d::UnitY());
    map.up.setZero();
    EXPECT_NEAR((up_of(map, scene::walk()) - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-9);
    EXPECT_EQ(up_of(map, {}), Eigen::Vector3d(0, -1, 0));
}

TEST(LevelFromWorld, TurnsUpToZAndWallsToTheAxes) {
    test::Random random(1);
    for (int i = 0; i < 10; ++i) {
        const Pose world_from_room = random.pose();
        std::vector<scene::Rectangle> planes = scene::walls(3, 2);
        planes.push_back(scene::upright(2, 2, 0, 0.4, 3, 2.5));  // across a corner: does not count
        const PlaneMap map = scene::map_of(planes, world_from_room);
        const Eigen::Matrix3d level = level_from_world(map, world_from_room.linear().col(2));
        EXPECT_TRUE((level * level.transpose()).isIdentity(1e-9));
        EXPECT_NEAR(level.determinant(), 1, 1e-9);
        EXPECT_NEAR((level * world_from_room.linear().col(2)).z(), 1, 1e-6);
        EXPECT_NEAR((level * world_from_room.linear().col(0)).cwiseAbs().maxCoeff(), 1, 1e-6);
    }
}

TEST(Walked, LeavesOutSmallStepsAndWhatIsNotFinite) {
    Trajectory trajectory;
    for (int i = 0; i <= 1000; ++i) {
        Pose pose = Pose::Identity();
        pose.translation().x() = 0.001 * i;
        trajectory.push_back({i, pose});
    }
    trajectory[500].world_from_camera.translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    const std::vector<Eigen::Vector3d> way = walked(trajectory);
    EXPECT_LE(way.size(), 101u);
    EXPECT_GE(way.size(), 90u);
    EXPECT_EQ(way.front().x(), 0);
    EXPECT_EQ(way.back().x(), 1) << "the last one is kept, however near";
    for (const Eigen::Vector3d& p : way) EXPECT_TRUE(p.allFinite());
    EXPECT_TRUE(walked({}).empty());
}

TEST(DrawablePlanes, AreFiniteAndHaveAnOutline) {
    PlaneMap map = scene::corner();
    ASSERT_EQ(drawable_planes(map).size(), 3u);
    map.planes[0].outline = {};
    map.planes[1].angle = std::numeric_limits<float>::quiet_NaN();
    map.planes[2].normal.setZero();
    EXPECT_TRUE(drawable_planes(map).empty());
}

TEST(MeshOf, HasTheOutlinesAreaOnThePlane) {
    for (const MapPlane& plane : scene::corner().planes) {
        const PlaneMesh mesh = mesh_of(plane);
        float area = 0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const auto v = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
            area += 0.5f * (v(b) - v(a)).cross(v(c) - v(a)).dot(plane.normal);
        }
        EXPECT_NEAR(area, plane.area, 1e-5);
        for (const auto& v : mesh.vertices)
            EXPECT_NEAR(plane.plane().signed_distance(v.cast<double>()), 0, 1e-6);
    }
}

TEST(Footprint, JoinsWhatIsAboveOneAnotherAndKeepsGaps) {
    // A wall along y with a door gap from y = 1 to 2, and a second part above the first.
    MapPlane wall(0, scene::region_of(scene::upright(0, 0, 0, 0, 6, 3), Pose::Identity(), 0.1), 1);
    const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
    const Pose plane_from_world = wall.world_from_plane().inverse();
    const auto ring = [&](double y0, double y1, double z0, double z1) {
        Ring corners;
        for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, y0, z0), Eigen::Vector3d(0, y1, z0),
                                         Eigen::Vector3d(0, y1, z1), Eigen::Vector3d(0, y0, z1)})
            corners.push_back((plane_from_world * p).head<2>());
        return corners;
    };
    wall.outline = MapOutline(
        Outline{{ring(-3, 1, 0, 1), ring(-2, 0.5, 2, 3), ring(2, 3, 0, 1), ring(-2, -1, 0.2, 0.4)}});
    const auto pieces = footprint(wall, level);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_NEAR(pieces[0].first.y(), -3, 1e-3);
    EXPECT_NEAR(pieces[0].second.y(), 1, 1e-3);
    EXPECT_NEAR(pieces[1].first.y(), 2, 1e-3);
    EXPECT_NEAR(pieces[1].second.y(), 3, 1e-3);
}

TEST(PlaneColor, TellsNeighbouringIdsApart) {
    for (int id = -2; id < 100; ++id) {
        const Rgb a = id_color(id), b = id_color(id + 1);
        EXPECT_GT(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 60) << id;
    }
}

}  // namespace
}  // namespace planemap::exports
