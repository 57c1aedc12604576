// SPDX-License-Identifier: BSD-3-Clause
#include "export/cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/id_color.hpp"
#include "evaluate/room.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

CameraInfo camera() {
    CameraInfo camera;
    camera.depth = camera.color = {160, 120, 130, 130, 79.5, 59.5};
    return camera;
}

/// The left half of what a camera at the origin sees of a wall 2 m away.
PlaneMap half_a_wall() {
    PlaneMap map;
    map.planes.push_back(evaluation::map_plane(5, {"wall", {-1, 0, 2}, {0, 0, -1}, {1, 0, 0}, 1, 2}));
    return map;
}

TEST(CloudMaker, PointsHaveThePlaneThatExplainsThem) {
    CloudMaker maker(half_a_wall(), {});
    maker.add(DepthImage(160, 120, 2000), camera(), Pose::Identity());
    ASSERT_FALSE(maker.points().empty());
    EXPECT_LE(maker.points().size(), 80u * 60) << "every second reading in x and y";
    std::set<int> planes;
    for (const CloudPoint& point : maker.points()) {
        EXPECT_FLOAT_EQ(point.position.z(), 2);
        planes.insert(point.plane);
        if (std::abs(point.position.x()) < 0.02f) continue;
        const bool is_on_it = point.position.x() < 0;
        EXPECT_EQ(point.plane, is_on_it ? 5 : CloudPoint::kNoPlane) << point.position.transpose();
        EXPECT_EQ(point.color, is_on_it ? id_color(5) : CloudPoint::kNoColor);
    }
    EXPECT_EQ(planes.size(), 2u);
}

TEST(CloudMaker, EachCubeHasOnePointHoweverOftenItIsSeen) {
    CloudMaker maker(half_a_wall(), {.voxel_m = 0.1});
    for (int i = 0; i < 4; ++i) maker.add(DepthImage(160, 120, 2000), camera(), Pose::Identity());
    std::set<std::pair<int, int>> cubes;
    for (const CloudPoint& point : maker.points())
        EXPECT_TRUE(cubes
                        .emplace(static_cast<int>(std::floor(point.position.x() / 0.1f)),
                                 static_cast<int>(std::floor(point.position.y() / 0.1f)))
                        .second);
    EXPECT_NEAR(static_cast<double>(cubes.size()), 26 * 20, 60) << "2.5 m by 1.8 m";
}

TEST(CloudMaker, CubesGrowWhereThereAreTooManyPoints) {
    CloudMaker maker(half_a_wall(), {.voxel_m = 0.02, .most = 1000});
    maker.add(DepthImage(160, 120, 2000), camera(), Pose::Identity());
    EXPECT_LE(maker.points().size(), 1000u);
    EXPECT_GT(maker.points().size(), 200u);
    EXPECT_GT(maker.voxel_m(), 0.02);
}

TEST(CloudMaker, ReadingsThatTheSensorIsNotTrustedWithAreLeftOut) {
    CloudMaker maker(half_a_wall(), {});
    CameraInfo near = camera();
    near.depth_max_m = 1.5;
    maker.add(DepthImage(160, 120, 2000), near, Pose::Identity());
    maker.add(DepthImage(160, 120), camera(), Pose::Identity());
    EXPECT_TRUE(maker.points().empty());
    EXPECT_THAT(error_of([] { CloudMaker({}, {.voxel_m = -1}); }), HasSubstr("voxel"));
}

}  // namespace
}  // namespace planemap
