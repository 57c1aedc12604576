// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_intake.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;

/// Regions of walls of these half widths, 3 m ahead.
std::vector<PlanarRegion> walls(const std::vector<double>& half_widths) {
    std::vector<Rectangle> walls;
    for (const double half : half_widths)
        walls.push_back({facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), half, 0.8, {}});
    return scene::keyframe(0, walls, Pose::Identity()).regions;
}

TEST(RegionIntake, TheLargestComeFirstAndKeepTheirNumber) {
    MapLosses losses;
    const auto regions = walls({0.3, 1.0, 0.6});
    const StoredKeyframe view = RegionIntake(200).view(4, 77, regions, {}, losses);
    ASSERT_EQ(view.regions.size(), 3u);
    EXPECT_EQ(view.id, 4);
    EXPECT_EQ(view.utime, 77);
    EXPECT_FALSE(view.world_from_camera);
    EXPECT_EQ(view.regions[0].number, 1);
    EXPECT_EQ(view.regions[1].number, 2);
    EXPECT_EQ(view.regions[2].number, 0);
    EXPECT_EQ(losses.regions_refused, 0u);
}

TEST(RegionIntake, WhatNoSensorSeesIsRefusedAndCounted) {
    auto regions = walls({1, 1, 1, 1, 1});
    regions[0].plane.d = std::numeric_limits<double>::quiet_NaN();
    regions[1].box.half_extents.x() = 1000;
    regions[2].box.frame_from_box.translation().z() += 50;
    regions[3].moments = {};
    MapLosses losses;
    const StoredKeyframe view = RegionIntake(200).view(0, 0, regions, {}, losses);
    ASSERT_EQ(view.regions.size(), 1u);
    EXPECT_EQ(view.regions[0].number, 4);
    EXPECT_EQ(losses.regions_refused, 4u);
}

TEST(RegionIntake, OfTooManyTheFirstAreTaken) {
    MapLosses losses;
    const auto regions = walls(std::vector<double>(300, 0.5));
    EXPECT_EQ(RegionIntake(200).view(0, 0, regions, {}, losses).regions.size(), 256u);
    EXPECT_EQ(losses.regions_too_many, 44u);
}

}  // namespace
}  // namespace planemap::map
