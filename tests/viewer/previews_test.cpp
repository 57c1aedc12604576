// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/previews.hpp"

#include <gtest/gtest.h>

#include "core/id_color.hpp"

namespace planemap::viewer {
namespace {

CameraInfo camera() {
    CameraInfo camera;
    camera.depth = camera.color = {64, 48, 60, 60, 31.5, 23.5};
    return camera;
}

/// The wall z = 2, of which the left half of the view is a region.
PlanarRegion left_half_of_a_wall() {
    PlanarRegion region;
    region.plane = {{0, 0, -1}, 2};
    region.box.frame_from_box.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    region.box.frame_from_box.translation() = Eigen::Vector3d(-1, 0, 2);
    region.outline.rings = {{{-1, -2}, {1, -2}, {1, 2}, {-1, 2}}};
    return region;
}

TEST(Previews, AreReducedToWhatFits) {
    EXPECT_EQ(reduction_to(320, 240, 320), 1);
    EXPECT_EQ(reduction_to(640, 480, 320), 2);
    EXPECT_EQ(reduction_to(1280, 720, 320), 4);
    EXPECT_EQ(reduction_to(480, 641, 320), 4);
    EXPECT_EQ(reduction_to(100000, 1, 320), 8) << "no more than a JPEG decoder reduces";
    const RgbImage odd = depth_preview(DepthImage(63, 47, 1000), camera(), 2);
    EXPECT_EQ(odd.width, 32);
    EXPECT_EQ(odd.height, 24);
}

TEST(Previews, NearIsWarmFarIsColdAndNothingIsBlack) {
    DepthImage depth(3, 1);
    depth.pixels = {400, 7900, 0};
    const RgbImage picture = depth_preview(depth, camera(), 1);
    EXPECT_GT(picture(0, 0).r, picture(0, 0).b);
    EXPECT_GT(picture(1, 0).b, picture(1, 0).r);
    EXPECT_EQ(picture(2, 0), (Rgb{0, 0, 0}));
}

TEST(Previews, RegionsHaveTheirColours) {
    const PlanarRegion wall = left_half_of_a_wall();
    DepthImage depth(64, 48, 2000);
    for (int v = 0; v < 48; ++v) depth(10, v) = 1000;  // before the wall
    const RgbImage picture = region_preview(depth, camera(), {&wall, 1}, 1);
    EXPECT_EQ(picture(5, 20), id_color(0));
    EXPECT_NE(picture(10, 20), id_color(0));
    EXPECT_NE(picture(50, 20), id_color(0));
    EXPECT_EQ(picture(50, 20).r, picture(50, 20).b) << "grey";
}

}  // namespace
}  // namespace planemap::viewer
