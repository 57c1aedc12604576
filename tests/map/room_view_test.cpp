// SPDX-License-Identifier: BSD-3-Clause
#include "map/room_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/furniture.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::map {
namespace {

using scene::facing_down;
using scene::level;
using scene::Rectangle;
using scene::upright;

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const double kSin2 = std::pow(std::sin(radians(10)), 2);

std::vector<Rectangle> room(const std::vector<Rectangle>& more = {}) {
    std::vector<Rectangle> planes = scene::walls(3, 2);
    planes.push_back(level(0, 0, 0, 3, 2));
    planes.push_back(facing_down(level(0, 0, 2.5, 3, 2)));
    planes.insert(planes.end(), more.begin(), more.end());
    return planes;
}

RoomView view_of(const std::vector<Rectangle>& rectangles) {
    return RoomView(scene::map_of(rectangles).planes);
}

TEST(Squareness, FallsToNothingAtTheTolerance) {
    const auto at = [](double deg) {
        return squareness({std::sin(radians(deg)), 0, std::cos(radians(deg))}, kUp, kSin2);
    };
    EXPECT_NEAR(at(0), 1, 1e-12);
    EXPECT_NEAR(at(180), 1, 1e-12) << "either way";
    EXPECT_NEAR(at(90), -1, 1e-12);
    EXPECT_NEAR(at(10), 0, 1e-9);
    EXPECT_NEAR(at(80), 0, 1e-9);
    EXPECT_EQ(at(45), 0);
    EXPECT_GT(at(3), at(5));
    EXPECT_LT(at(87), at(85));
}

TEST(RoomView, WeighsPlanesByTheRootOfTheirAreas) {
    const RoomView view = view_of({level(0, 0, 0, 2, 2), level(0, 0, 1, 1, 1), level(0, 3, 1, 1, 1)});
    ASSERT_EQ(view.planes().size(), 3u);
    EXPECT_NEAR(view.planes()[0].weight, 0.5, 1e-3);
    EXPECT_NEAR(view.planes()[1].weight, 0.25, 1e-3);
    const RoomView::Seen::Range range = view.planes()[0].along(Eigen::Vector3d::UnitX());
    EXPECT_NEAR(range.low, -2, 1e-2);
    EXPECT_NEAR(range.length(), 4, 2e-2);
    EXPECT_NEAR(range.middle(), 0, 1e-2);
}

TEST(RoomView, ARoomIsSquareAboutItsUpAlone) {
    const RoomView view = view_of(room());
    EXPECT_NEAR(view.square(kUp, kSin2), 1, 1e-6);
    EXPECT_NEAR(view.square(-kUp, kSin2), 1, 1e-6);
    EXPECT_LT(view.square(Eigen::Vector3d(0.5, 0.6, 0.7).normalized(), kSin2), 0.1);
}

TEST(RoomView, TablesFaceUpAndLieLow) {
    const RoomView::Reading up =
        view_of(room({level(1, 1, 0.75, 0.8, 0.5), level(-1, 1, 0.75, 0.5, 0.5)})).read(kUp, kSin2);
    EXPECT_GT(up.facing_up, 0.5);
    EXPECT_GT(up.low, 0);
    const RoomView::Reading down =
        view_of(room({level(1, 1, 0.75, 0.8, 0.5), level(-1, 1, 0.75, 0.5, 0.5)})).read(-kUp, kSin2);
    EXPECT_NEAR(down.facing_up, -up.facing_up, 1e-9);
    EXPECT_NEAR(down.low, -up.low, 1e-9);
    const RoomView::Reading empty = view_of(room()).read(kUp, kSin2);
    EXPECT_EQ(empty.facing_up, 0);
    EXPECT_EQ(empty.hanging, 0);
}

TEST(RoomView, UnderWhatHangsTheWallBehindIsSeen) {
    // A cupboard's front at 1 m height, one metre before the wall.
    const std::vector<Rectangle> planes = room({upright(-2, 0, 1, 0, 1, 0.8)});
    EXPECT_GT(view_of(planes).read(kUp, kSin2).hanging, 0.3);
    EXPECT_EQ(view_of(room({upright(-2, 0, 0, 0, 1, 0.8)})).read(kUp, kSin2).hanging, 0) << "it stands";
}

TEST(RoomView, WhatIsNoPlaneIsLeftOut) {
    PlaneMap map = scene::map_of({level(0, 0, 0, 1, 1), level(0, 0, 1, 1, 1), level(0, 0, 2, 1, 1)});
    map.planes[0].normal.x() = std::numeric_limits<float>::quiet_NaN();
    map.planes[1].area = 0;
    EXPECT_EQ(RoomView(map.planes).planes().size(), 1u);
    const RoomView none{std::span<const MapPlane>()};
    EXPECT_EQ(none.square(kUp, kSin2), 0);
    EXPECT_EQ(none.read(kUp, kSin2).low, 0);
}

}  // namespace
}  // namespace planemap::map
