// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/stored_scan.hpp"

#include <gtest/gtest.h>

#include <random>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

TEST(StoredScan, GivesBackEachReadingWhereItIs) {
    CameraInfo camera = test::small_camera();
    camera.depth_min_m = 0;
    camera.depth_max_m = 100;
    std::mt19937_64 random(5);
    std::uniform_int_distribution<int> raw(0, 65535);
    DepthImage depth(64, 48);
    for (auto& pixel : depth.pixels) pixel = static_cast<std::uint16_t>(raw(random));
    const Pose world_from_camera = test::pose(0.1, 2);
    const auto points = StoredScan(depth, camera).points(world_from_camera, 1);
    auto point = points.begin();
    for (int v = 0; v < 48; ++v) {
        for (int u = 0; u < 64; ++u) {
            if (!is_valid_depth(depth(u, v))) continue;
            const Eigen::Vector3d p =
                world_from_camera * camera.depth.unproject(u, v, camera.metres(depth(u, v)));
            ASSERT_NE(point, points.end());
            EXPECT_NEAR(p.x(), point->x(), 1e-4);
            EXPECT_NEAR(p.y(), point->y(), 1e-4);
            EXPECT_NEAR(p.z(), point->z(), 1e-4);
            ++point;
        }
    }
    EXPECT_EQ(point, points.end());
}

TEST(StoredScan, TakesFewerBytesThanTheImage) {
    const CameraInfo camera = test::small_camera();
    EXPECT_LT(StoredScan(test::room(camera), camera).bytes(), 64u * 48u);
}

TEST(StoredScan, RefusesWhatIsNoScan) {
    CameraInfo camera = test::small_camera();
    EXPECT_THROW(StoredScan(DepthImage(), camera), std::invalid_argument);
    EXPECT_THROW(StoredScan(DepthImage(48, 64), camera), std::invalid_argument);
    camera.depth.fx = 0;
    EXPECT_THROW(StoredScan(DepthImage(64, 48), camera), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::octomap
