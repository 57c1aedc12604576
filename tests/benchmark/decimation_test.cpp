// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/decimation.hpp"

#include <gtest/gtest.h>

#include "segmentation/scene.hpp"

namespace planemap::benchmark {
namespace {

namespace scene = segmentation::scene;

TEST(Decimated, CameraSeesTheSamePointsInTheSamePlaces) {
    const CameraInfo camera = scene::camera(645, 481);
    const DepthImage depth = scene::render(camera, {scene::plane(scene::tilted(0, 0.5, {0, 0, 2}))});
    for (const int step : {1, 2, 3, 4}) {
        const DepthImage small = decimated(depth, step);
        const CameraInfo small_camera = decimated(camera, step);
        EXPECT_NO_THROW(segmentation::check_input(small, small_camera));
        EXPECT_EQ(small.width, (645 + step - 1) / step);
        for (int v = 0; v < small.height; v += 11) {
            for (int u = 0; u < small.width; u += 11) {
                ASSERT_EQ(small(u, v), depth(u * step, v * step));
                const double z = camera.metres(small(u, v));
                EXPECT_LT(
                    (small_camera.depth.unproject(u, v, z) - camera.depth.unproject(u * step, v * step, z))
                        .norm(),
                    1e-12);
            }
        }
    }
}

TEST(Decimated, TwoCamerasCanStillBeRegistered) {
    CameraInfo camera = scene::camera();
    camera.registered = false;
    camera.color.fx = camera.color.fy = 1.2 * camera.depth.fx;
    for (const int step : {2, 4, 8}) {
        const DepthImage small((camera.depth.width + step - 1) / step,
                               (camera.depth.height + step - 1) / step);
        EXPECT_NO_THROW(segmentation::check_input(small, decimated(camera, step))) << step;
    }
}

}  // namespace
}  // namespace planemap::benchmark
