// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/collections.hpp"

#include <gtest/gtest.h>

#include "core/id_color.hpp"

namespace planemap::viewer {
namespace {

/// z up, where the world's y is down.
Pose local_from_world() {
    Pose pose = Pose::Identity();
    pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    pose.translation() = Eigen::Vector3d(0, 0, 1.5);
    return pose;
}

TEST(Collections, OutlinesAreClosedLinesInTheLocalFrame) {
    PlanarRegion floor;
    floor.plane = {{0, -1, 0}, 1.5};  // y = 1.5
    floor.box.frame_from_box.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    floor.box.frame_from_box.linear().col(2) = floor.plane.normal;
    floor.box.frame_from_box.linear().col(1) = floor.plane.normal.cross(Eigen::Vector3d::UnitX());
    floor.box.frame_from_box.translation() = Eigen::Vector3d(0, 1.5, 3);
    floor.outline.rings = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {{0, 0}, {0.5, 0}, {0.5, 0.5}}};
    PlaneMap map;
    map.planes = {MapPlane(4, floor, 2)};
    const vs::point3d_list_collection_t collection = plane_collection(map, local_from_world());
    EXPECT_EQ(collection.type, vs::point3d_list_collection_t::LINE_LOOP);
    ASSERT_EQ(collection.nlists, 2);
    const vs::point3d_list_t& outer = collection.point_lists[0];
    EXPECT_EQ(outer.npoints, 4);
    EXPECT_EQ(outer.ncolors, 4);
    EXPECT_EQ(outer.collection, local_frame_collection().id) << "attached to the local frame's origin,";
    EXPECT_EQ(outer.element_id, local_frame_collection().objects[0].id);
    for (const vs::point3d_t& p : outer.points) {
        EXPECT_NEAR(p.z, 0, 1e-3) << "the floor is at height 0";
        EXPECT_NEAR(std::abs(p.x - 3), 1, 1e-3);
        EXPECT_NEAR(std::abs(p.y), 1, 1e-3);
    }
    EXPECT_NEAR(255 * static_cast<double>(outer.colors[0].g), id_color(4).g, 0.5);
}

TEST(Collections, KeyframesArePosesOfTheBody) {
    Pose body_from_camera = Pose::Identity();
    body_from_camera.linear() = local_from_world().linear();
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{0, 1, Pose::Identity()}, {7, 2, Pose(Eigen::Translation3d(0, 0, 2))}};
    const vs::object_collection_t collection =
        keyframe_collection(trajectory, local_from_world(), body_from_camera);
    ASSERT_EQ(collection.nobjects, 2);
    EXPECT_EQ(collection.type, vs::object_collection_t::POSE3D);
    EXPECT_EQ(collection.objects[1].id, 7);
    EXPECT_NEAR(collection.objects[1].x, 2, 1e-9) << "ahead of the first camera";
    EXPECT_NEAR(collection.objects[1].z, 1.5, 1e-9);
    EXPECT_NEAR(std::abs(collection.objects[1].qw), 1, 1e-9) << "level, looking ahead";
}

}  // namespace
}  // namespace planemap::viewer
