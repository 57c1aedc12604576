// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/rgbd_plane.hpp"

#include <gtest/gtest.h>

#include "segmentation/scene.hpp"

namespace planemap::benchmark {
namespace {

namespace scene = segmentation::scene;

TEST(RgbdPlane, FindsAWallOnEveryFourthPixelAndTellsItsTime) {
    const CameraInfo camera = scene::camera();
    const Plane wall = scene::tilted(0, 0, {0, 0, 2});
    const DepthImage depth = scene::render(camera, {scene::plane(wall)});
    const auto finder = make_rgbd_plane(rgbd_plane_block_px(4), false);
    EXPECT_GT(timed_find(*finder, depth, camera, 4), 0);
    segmentation::Segmentation found;
    finder->result(found);
    EXPECT_NE(scene::find(found, wall, 2, 20), nullptr);
    EXPECT_EQ(found.labels.width, (depth.width + 3) / 4);
}

TEST(RgbdPlane, BlocksCoverTheSameOfTheSceneButAreNeverTiny) {
    EXPECT_EQ(rgbd_plane_block_px(1), 40);
    EXPECT_EQ(rgbd_plane_block_px(4), 10);
    EXPECT_EQ(rgbd_plane_block_px(16), 4);
}

}  // namespace
}  // namespace planemap::benchmark
