// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/prepared_frame.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "room.hpp"

namespace planemap::odometry {
namespace {

const OdometryOptions kOptions;

TEST(PreparedFrameTest, HoldsWhatTheFrameHolds) {
    const CameraInfo camera = room_camera();
    const RenderedFrame images = render_room(camera, Pose::Identity());
    const PlanarRegion wall = whole_view(camera, images.depth);
    PlanarRegion broken = wall;
    broken.plane.d = std::numeric_limits<double>::quiet_NaN();
    const std::vector<PlanarRegion> regions{broken, wall};
    const PreparedFrame frame =
        prepare(kOptions, {1000, 3500, &images.gray, &images.depth, &camera, regions}, 0.02);
    EXPECT_EQ(frame.utime, 1000);
    EXPECT_NEAR(frame.color_offset_s, 0.0025, 1e-12);
    EXPECT_EQ(frame.readout_s, 0.02);
    EXPECT_EQ(frame.pyramid.levels(), kOptions.flow_wide_levels);
    EXPECT_GT(frame.samples.size(), 900u);
    ASSERT_EQ(frame.regions.size(), 1u) << "the broken one is left out";
    EXPECT_EQ(frame.regions[0].plane.d, wall.plane.d);
}

TEST(PreparedFrameTest, WithoutColourThereIsNoPyramidAndNoOffset) {
    const CameraInfo camera = room_camera();
    const DepthImage depth(320, 240, 0);
    const PreparedFrame frame = prepare(kOptions, {1000, 3500, nullptr, &depth, &camera, {}}, 0);
    EXPECT_TRUE(frame.pyramid.empty());
    EXPECT_EQ(frame.color_offset_s, 0);
    EXPECT_TRUE(frame.samples.empty());
    const GrayImage gray(320, 240, 0);
    EXPECT_EQ(prepare(kOptions, {1000, 0, &gray, &depth, &camera, {}}, 0).color_offset_s, 0)
        << "a colour time of 0 is the depth's";
}

TEST(PreparedFrameTest, WrongSizesAndMissingPartsAreNamed) {
    const CameraInfo camera = room_camera();
    const DepthImage depth(320, 240, 0), thin(320, 239, 0);
    const GrayImage gray(320, 240, 0), small(10, 10, 0);
    EXPECT_NO_THROW(check({0, 0, &gray, &depth, &camera, {}}));
    EXPECT_NO_THROW(check({0, 0, nullptr, &depth, &camera, {}}));
    EXPECT_THROW(check({0, 0, &small, &depth, &camera, {}}), std::invalid_argument);
    EXPECT_THROW(check({0, 0, &gray, &thin, &camera, {}}), std::invalid_argument);
    EXPECT_THROW(check({0, 0, &gray, nullptr, &camera, {}}), std::invalid_argument);
    EXPECT_THROW(check({0, 0, &gray, &depth, nullptr, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::odometry
