// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log_contents.hpp"

#include <gtest/gtest.h>

#include <bot_core/images_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <kinect/frame_msg_t.hpp>
#include <planemap/acceleration_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <planemap/earlier_plane_map_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/look_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/seen_space_t.hpp>
#include <planemap/surfaces_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <vs/object_collection_t.hpp>
#include <vs/point3d_list_collection_t.hpp>

namespace planemap::messages {
namespace {

template <typename... Types>
void expect_names(const std::string& package) {
    const auto expect = [&](std::int64_t hash, const std::string& type) {
        EXPECT_EQ(type_name(static_cast<std::uint64_t>(hash)), package + "." + type);
    };
    (expect(Types::getHash(), Types::getTypeName()), ...);
}

TEST(LogContents, EveryTypeThatAModulePublishesOrReadsHasAName) {
    expect_names<acceleration_t, camera_info_t, keyframe_t, look_t, map_size_t, module_status_t, odometry_t,
                 planar_regions_t, plane_map_t, earlier_plane_map_t, seen_space_t, surfaces_t, trajectory_t>(
        "planemap");
    expect_names<bot_core::image_t, bot_core::images_t, bot_core::pose_t, bot_core::rigid_transform_t>(
        "bot_core");
    expect_names<kinect::frame_msg_t>("kinect");
    expect_names<vs::object_collection_t, vs::point3d_list_collection_t>("vs");
    EXPECT_EQ(type_name(0x123), "0x0000000000000123");
}

}  // namespace
}  // namespace planemap::messages
