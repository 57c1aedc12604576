// SPDX-License-Identifier: BSD-3-Clause
#include "core/plane_map.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/random_values.hpp"
#include "core/scene.hpp"

namespace planemap {
namespace {

using scene::facing;
using scene::Rectangle;
using scene::rectangle_ring;

const Outline kFrame{{rectangle_ring(-1, -0.5, 1, 0.5), rectangle_ring(-0.5, -0.25, 0.5, 0.25)}};

MapPlane plane_of(const Pose& world_from_face, int id = 0) {
    const Rectangle face{world_from_face, 1, 0.5, {kFrame.rings[1]}};
    return MapPlane(id, scene::region_of(face, Pose::Identity()), 3);
}

TEST(MapOutline, KeepsRingsAsRoundedByPacking) {
    const MapOutline outline(kFrame);
    EXPECT_FALSE(outline.empty());
    EXPECT_EQ(outline.ring_count(), 2u);
    EXPECT_EQ(outline.vertex_count(), 8u);
    const Outline rings = outline.rings();
    ASSERT_EQ(rings.rings.size(), 2u);
    for (std::size_t r = 0; r < 2; ++r) {
        ASSERT_EQ(rings.rings[r].size(), 4u);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_LE((rings.rings[r][i] - kFrame.rings[r][i]).cwiseAbs().maxCoeff(),
                      0.5 * static_cast<double>(outline.unit) + 1e-9);
    }
    EXPECT_EQ(MapOutline(rings), outline) << "packing it again changes nothing";
    EXPECT_TRUE(MapOutline(Outline()).empty());
    EXPECT_EQ(MapOutline().ring_count(), 0u);
    EXPECT_EQ(MapOutline().vertex_count(), 0u);
    EXPECT_TRUE(MapOutline().rings().empty());
}

TEST(MapPlane, LiesWhereItsRegionDoesInAnyPose) {
    test::Random random(5);
    for (int i = 0; i < 50; ++i) {
        const Pose world_from_face = random.pose();
        const MapPlane plane = plane_of(world_from_face, 7);
        EXPECT_EQ(plane.id, 7);
        EXPECT_NEAR(plane.area, 2 - 0.5, 1e-3);
        EXPECT_LT(angle_between(plane.plane().normal, world_from_face.linear().col(2)), 1e-5);
        EXPECT_LT(std::abs(plane.plane().signed_distance(world_from_face.translation())), 1e-4);
        const Pose world_from_plane = plane.world_from_plane();
        EXPECT_NEAR(world_from_plane.linear().determinant(), 1, 1e-9);
        // Its x is the box's: what lies at the face's x, y lies at the plane's.
        for (const Eigen::Vector3d& p :
             {Eigen::Vector3d(1, 0.5, 0), Eigen::Vector3d(-0.5, 0.25, 0), Eigen::Vector3d(0.3, -0.1, 0)})
            EXPECT_LT((world_from_plane * p - world_from_face * p).norm(), 1e-4);
    }
}

TEST(MapPlane, MovedItLiesOnThePlaneWithItsOutline) {
    test::Random random(6);
    for (int i = 0; i < 20; ++i) {
        const Pose world_from_face = random.pose();
        MapPlane plane = plane_of(world_from_face);
        const Pose before = plane.world_from_plane();
        Plane target = plane.plane();
        target.normal = (target.normal + 0.05 * random.direction()).normalized();
        target.d = -target.normal.dot(plane.center.cast<double>()) + 0.02;
        plane.move_to(target);
        EXPECT_LT(angle_between(plane.plane().normal, target.normal), 1e-5);
        EXPECT_LT(std::abs(target.signed_distance(plane.center.cast<double>())), 1e-4);
        EXPECT_LT(angle_between(before.linear().col(0), plane.world_from_plane().linear().col(0)), 0.06)
            << "it hardly turns in its plane";
        EXPECT_EQ(plane.outline, plane_of(world_from_face).outline);
    }
}

TEST(MapPlane, AsARegionItSaysWhatItHolds) {
    const MapPlane plane = plane_of(facing({1, 2, 3}, {0, 1, 0}, {1, 0, 0}));
    const PlanarRegion region = plane.region();
    EXPECT_EQ(region.moments.count, static_cast<double>(plane.inliers));
    EXPECT_EQ(region.outline.vertex_count(), 8u);
    EXPECT_NEAR(region.box.half_extents.x(), 1, 1e-6);
    EXPECT_NEAR(region.box.half_extents.y(), 0.5, 1e-6);
    EXPECT_NEAR(distance(plane, {1, 2.25, 3}), std::hypot(0.25, 0.25), 1e-3) << "over the middle of its hole";
    EXPECT_NEAR(distance(plane, {4, 2, 3}), 2, 1e-3);
}

TEST(MapPlane, ManyKeyframesAreThatManyOrMore) {
    const PlanarRegion region = scene::region_of({Pose::Identity(), 1, 1, {}}, Pose::Identity());
    EXPECT_EQ(MapPlane(0, region, 32766).keyframes, 32766);
    EXPECT_EQ(MapPlane(0, region, 1000000).keyframes, 32767);
}

TEST(PlaneMap, FindsByIdWhatItHolds) {
    PlaneMap map;
    EXPECT_EQ(map.find(0), nullptr);
    for (const int id : {-3, 2, 5, 40}) map.planes.push_back(plane_of(Pose::Identity(), id));
    map.inferred = {{2, MapOutline(kFrame)}, {40, {}}};
    for (std::size_t i = 0; i < map.planes.size(); ++i) EXPECT_EQ(map.find(map.planes[i].id), &map.planes[i]);
    for (const int id : {-4, 0, 3, 41, std::numeric_limits<int>::max()}) EXPECT_EQ(map.find(id), nullptr);
    EXPECT_EQ(map.inferred_of(2), &map.inferred[0].outline);
    EXPECT_EQ(map.inferred_of(40), &map.inferred[1].outline);
    EXPECT_EQ(map.inferred_of(5), nullptr);
}

TEST(PlaneMap, CountsTheBytesOfAllItHolds) {
    PlaneMap map;
    EXPECT_EQ(memory_bytes(map), sizeof map);
    map.planes.push_back(plane_of(Pose::Identity()));
    const std::size_t one = memory_bytes(map);
    EXPECT_EQ(one, sizeof map + map.planes.capacity() * sizeof(MapPlane) +
                       map.planes[0].outline.packed.capacity() * sizeof(std::int16_t));
    map.inferred.push_back({0, MapOutline(kFrame)});
    map.lines.resize(3);
    map.points.resize(2);
    EXPECT_EQ(memory_bytes(map), one + map.inferred.capacity() * sizeof(InferredRings) +
                                     map.inferred[0].outline.packed.capacity() * sizeof(std::int16_t) +
                                     map.lines.capacity() * sizeof(IntersectionLine) +
                                     map.points.capacity() * sizeof(IntersectionPoint));
}

TEST(PlaneLabel, AllHaveNames) {
    EXPECT_STREQ(label_name(PlaneLabel::kUnknown), "unknown");
    EXPECT_STREQ(label_name(PlaneLabel::kFloor), "floor");
    EXPECT_STREQ(label_name(PlaneLabel::kVertical), "vertical");
    EXPECT_STREQ(label_name(static_cast<PlaneLabel>(100)), "unknown");
}

}  // namespace
}  // namespace planemap
