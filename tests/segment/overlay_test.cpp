// SPDX-License-Identifier: BSD-3-Clause
#include "segment/overlay.hpp"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "segment/small_scene.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap {
namespace {

std::tuple<int, int, int> values(const Rgb& color) {
    return {color.r, color.g, color.b};
}

TEST(Overlay, EachRegionHasAColourOfItsOwnAndWhatIsUnreadIsBlack) {
    const CameraInfo camera = small_camera();
    const DepthImage depth = small_depth();
    segmentation::Segmentation segmentation;
    segmentation::make_segmenter({})->segment(depth, camera, segmentation);
    ASSERT_GE(segmentation.regions.size(), 2u);
    const RgbImage picture = draw_overlay(depth, camera, segmentation);
    ASSERT_EQ(picture.width, 320);
    ASSERT_EQ(picture.height, 240);
    EXPECT_EQ(depth(160, 100), 0) << "the window";
    EXPECT_EQ(picture(160, 100), Rgb{});
    EXPECT_NE(picture(40, 30), Rgb{});
    EXPECT_NE(values(picture(40, 30)), values(picture(40, 230))) << "wall and floor";
}

TEST(Overlay, WorksWithoutRegionsAndOnTinyImages) {
    for (const int side : {1, 2, 5}) {
        const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
        const CameraInfo camera = scene::camera(side, side);
        segmentation::Segmentation none;
        none.labels = Image<std::uint16_t>(side, side);
        const RgbImage picture = draw_overlay(DepthImage(side, side, 1000), camera, none);
        EXPECT_EQ(picture.pixels.size(), pixels);
        std::set<std::tuple<int, int, int>> colors;
        for (const Rgb& color : picture.pixels) colors.insert({color.r, color.g, color.b});
        for (const auto& [r, g, b] : colors) EXPECT_TRUE(r == g && g == b) << "grey: no region";
    }
}

TEST(Overlay, ARegionBehindTheCameraDoesNotHarm) {
    const CameraInfo camera = small_camera();
    segmentation::Segmentation segmentation;
    segmentation.labels = Image<std::uint16_t>(320, 240);
    PlanarRegion& region = segmentation.regions.emplace_back();
    region.box.frame_from_box.translation() = Eigen::Vector3d(0, 0, -1);
    region.outline.rings = {{{0, 0}, {1, 0}, {1, 1}}};
    EXPECT_EQ(draw_overlay(small_depth(), camera, segmentation).width, 320);
}

}  // namespace
}  // namespace planemap
