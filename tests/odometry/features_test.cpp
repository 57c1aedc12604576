// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/features.hpp"

#include <gtest/gtest.h>

#include "places/matching.hpp"
#include "room.hpp"

namespace planemap::odometry {
namespace {

const CornerOptions kCorners = corner_options({});

PlanarRegion wall_region(double distance_m) {
    PlanarRegion region;
    region.plane = {{0, 0, -1}, distance_m};
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) region.moments.add({x, y, distance_m});
    region.box.frame_from_box.linear() = plane_axes(region.plane.normal, {1, 0, 0});
    region.box.frame_from_box.translation() = Eigen::Vector3d(0, 0, distance_m);
    region.box.half_extents = {1, 1, 0};
    return region;
}

TEST(SoundDepth, IsTheDepthAwayFromEdgesOnly) {
    const CameraInfo camera = room_camera();
    DepthImage depth(320, 240, 10000);
    for (int v = 0; v < 240; ++v)
        for (int u = 160; u < 320; ++u) depth(u, v) = 15000;
    EXPECT_NEAR(sound_depth(depth, camera, {80, 100}, 0.04), 2, 1e-9);
    EXPECT_EQ(sound_depth(depth, camera, {159, 100}, 0.04), 0);
    EXPECT_EQ(sound_depth(depth, camera, {0, 0}, 0.04), 0);
    EXPECT_EQ(sound_depth(depth, camera, {1000, 1000}, 0.04), 0);
    EXPECT_EQ(sound_depth(DepthImage(320, 240, 0), camera, {80, 100}, 0.04), 0);
    EXPECT_EQ(sound_depth(DepthImage(320, 240, 65535), camera, {80, 100}, 0.04), 0);
}

TEST(SelectCorners, SpreadsOverCellsWithDepth) {
    const CameraInfo camera = room_camera();
    const RenderedFrame frame = render_room(camera, Pose::Identity());
    const auto corners = select_corners(frame.gray, frame.depth, camera, kCorners);
    EXPECT_GT(corners.size(), 40u);
    EXPECT_LE(corners.size(), 300u);
    EXPECT_TRUE(select_corners(frame.gray, DepthImage(320, 240, 0), camera, kCorners).empty());
    EXPECT_TRUE(select_corners(GrayImage(320, 240, 0), frame.depth, camera, kCorners).empty());
}

TEST(Regularised, StaysOnItsPixelAndLiesOnThePlane) {
    const Plane plane{Eigen::Vector3d(0.3, -0.2, -1).normalized(), 2};
    const Eigen::Vector3d point(0.4, 0.1, 2.1), result = regularised(plane, point);
    EXPECT_NEAR(plane.signed_distance(result), 0, 1e-12);
    EXPECT_LT(result.cross(point).norm(), 1e-12);
    const Plane grazed{{0, 1, 0}, 1};
    EXPECT_EQ(regularised(grazed, {0, 0, 2}), Eigen::Vector3d(0, 0, 2));
}

TEST(RegionOf, NearestPlaneWithinNoiseAndOutline) {
    const std::vector<PlanarRegion> regions{wall_region(2), wall_region(2.5)};
    EXPECT_EQ(region_of(regions, {0, 0, 2.01}, 0.01), 0);
    EXPECT_EQ(region_of(regions, {0, 0, 2.49}, 0.01), 1);
    EXPECT_EQ(region_of(regions, {0, 0, 2.2}, 0.01), -1);
    EXPECT_EQ(region_of(regions, {1.2, 0, 2}, 0.01), -1);
    EXPECT_EQ(region_of({}, {0, 0, 2}, 0.01), -1);
}

TEST(Descriptors, TheirDistanceCountsBits) {
    Descriptor a{}, b{};
    EXPECT_EQ(places::hamming_distance(a, b), 0);
    b.fill(0xff);
    EXPECT_EQ(places::hamming_distance(a, b), 256);
    b.fill(0);
    b[31] = 0x05;
    EXPECT_EQ(places::hamming_distance(a, b), 2);
}

TEST(Descriptors, AFrameMatchesItself) {
    const CameraInfo camera = room_camera();
    const RenderedFrame frame = render_room(camera, Pose::Identity());
    const auto features = describe(frame.gray, frame.depth, camera, 300, 0.04);
    EXPECT_GT(features.size(), 100u);
    const auto matches = match_descriptors(features, features, 64);
    EXPECT_GT(matches.size(), features.size() / 2);
    for (const auto& [i, j] : matches)
        EXPECT_EQ(places::hamming_distance(features[static_cast<std::size_t>(i)].descriptor,
                                           features[static_cast<std::size_t>(j)].descriptor),
                  0);
    EXPECT_TRUE(match_descriptors({}, features, 64).empty());
    EXPECT_TRUE(match_descriptors(features, {}, 64).empty());
}

}  // namespace
}  // namespace planemap::odometry
