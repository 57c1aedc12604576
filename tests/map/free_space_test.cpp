// SPDX-License-Identifier: BSD-3-Clause
#include "map/free_space.hpp"

#include <gtest/gtest.h>

#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::drawn_estimate_of;
using samples::stored_at;
using samples::wall_at;
using scene::facing;
using scene::Rectangle;

constexpr double kMargin_m = 0.05;
const FreeSpace kFreeSpace{kMargin_m};

double shape_area(const PlaneEstimate& plane) {
    return area(plane.grid.outline({}));
}

/// What is left of a plate 2 m ahead after keyframes at the origin that see these, one after the other.
double left_after(const std::vector<Rectangle>& seen, int times = 1, int strength = 0) {
    std::vector<PlaneEstimate> planes{drawn_estimate_of(wall_at(0, 0, 2), 0, strength)};
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), seen);
    for (int i = 0; i < times; ++i) kFreeSpace.carve(planes, Viewpoint(keyframe));
    return shape_area(planes[0]);
}

TEST(FreeSpace, AWallSeenBehindAPlaneRefutesIt) {
    EXPECT_NEAR(left_after({}), 1, 0.06);
    EXPECT_EQ(left_after({wall_at(0, 0, 4, 3)}), 0);
    EXPECT_NEAR(left_after({wall_at(0, 0, 4, 3)}, 1, 2), 1, 0.06)
        << "seen from near: two misses are not four hits";
    EXPECT_EQ(left_after({wall_at(0, 0, 4, 3)}, 3, 2), 0);
}

TEST(FreeSpace, WhatIsBeforeAPlaneOrOnItSaysNothing) {
    EXPECT_NEAR(left_after({wall_at(0, 0, 1, 2)}, 5), 1, 0.06) << "it hides the plane";
    EXPECT_NEAR(left_after({wall_at(0, 0, 2, 2)}, 5), 1, 0.06) << "it is the plane";
    EXPECT_NEAR(left_after({wall_at(0, 0, 2 + kMargin_m, 2)}, 5), 1, 0.06) << "within the noise";
}

TEST(FreeSpace, OnlyWhatIsSeenPastGoes) {
    // A wall of which the left half only is seen beyond the plate.
    const Rectangle left{facing({-1.5, 0, 4}, {0, 0, -1}, {1, 0, 0}), 1.5, 3, {}};
    EXPECT_NEAR(left_after({left}), 0.5, 0.12);
}

TEST(FreeSpace, ACameraThatLooksElsewhereCarvesNothing) {
    std::vector<PlaneEstimate> planes{drawn_estimate_of(wall_at(0, 0, 2), 0)};
    planes[0].changed = false;
    planes[0].changed_cells = 0;
    const Pose away = scene::camera_at({0, 0, 6});  // the plate lies behind it
    const StoredKeyframe keyframe = stored_at(away, {wall_at(0, 0, 9, 3)});
    kFreeSpace.carve(planes, Viewpoint(keyframe));
    EXPECT_NEAR(shape_area(planes[0]), 1, 0.06);
    EXPECT_FALSE(planes[0].changed);
    EXPECT_EQ(planes[0].changed_cells, 0);
}

TEST(FreeSpace, TellsHowManyCellsWent) {
    std::vector<PlaneEstimate> planes{drawn_estimate_of(wall_at(0, 0, 2), 0)};
    planes[0].changed = false;
    planes[0].changed_cells = 0;
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), {wall_at(0, 0, 4, 3)});
    kFreeSpace.carve(planes, Viewpoint(keyframe));
    EXPECT_TRUE(planes[0].changed);
    EXPECT_NEAR(planes[0].changed_cells, 1600, 90);
}

TEST(FreeSpace, ManyViewpointsSayWhatOneAfterTheOtherDo) {
    std::vector<StoredKeyframe> keyframes;
    for (int i = 0; i < 5; ++i)
        keyframes.push_back(stored_at(scene::camera_at({0.1 * i, 0, 0}), {wall_at(0, 0, 4, 2.5)}));
    std::vector<Viewpoint> viewpoints;
    for (const StoredKeyframe& keyframe : keyframes) viewpoints.emplace_back(keyframe);
    PlaneEstimate at_once = drawn_estimate_of(wall_at(0.4, 0.3, 2, 0.8), 0, 2);
    std::vector<PlaneEstimate> one_by_one{at_once};
    kFreeSpace.carve(at_once, viewpoints);
    for (const Viewpoint& viewpoint : viewpoints) kFreeSpace.carve(one_by_one, viewpoint);
    EXPECT_LT(shape_area(at_once), 2.56);
    EXPECT_NEAR(shape_area(at_once), shape_area(one_by_one[0]), 1e-9);
}

TEST(FreeSpace, OfNothing) {
    std::vector<PlaneEstimate> none, empty(1);
    const StoredKeyframe blind = stored_at(Pose::Identity(), {});
    kFreeSpace.carve(none, Viewpoint(blind));
    kFreeSpace.carve(empty, Viewpoint(blind));
    kFreeSpace.carve(empty[0], {});
    PlaneEstimate plane = drawn_estimate_of(wall_at(0, 0, 2), 0);
    kFreeSpace.carve(plane, {Viewpoint(blind)});
    EXPECT_NEAR(shape_area(plane), 1, 0.06);
}

}  // namespace
}  // namespace planemap::map
