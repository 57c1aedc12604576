// SPDX-License-Identifier: BSD-3-Clause
#include "map/free_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "map/estimates.hpp"
#include "map/evidence_shape.hpp"

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
    return area(outline_of(plane.grid, samples::kOutline));
}

/// What is left of a plate 2 m ahead, which some looks saw, after others from the origin that see these.
double left_after(const std::vector<Rectangle>& seen, int times = 1, int looks = 1) {
    std::vector<PlaneEstimate> planes{drawn_estimate_of(wall_at(0, 0, 2), 0, 0, looks)};
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), seen);
    for (int i = 0; i < times; ++i) kFreeSpace.carve(planes, Viewpoint(keyframe), 1);
    return shape_area(planes[0]);
}

TEST(FreeSpace, AWallSeenBehindAPlaneRefutesIt) {
    EXPECT_NEAR(left_after({}), 1, 0.06);
    EXPECT_EQ(left_after({wall_at(0, 0, 4, 3)}), 0);
    EXPECT_NEAR(left_after({wall_at(0, 0, 4, 3)}, 1, 2), 1, 0.06) << "seen twice, looked through once";
    EXPECT_EQ(left_after({wall_at(0, 0, 4, 3)}, 2, 2), 0);
    EXPECT_EQ(left_after({wall_at(0, 0, 4, 3)}, 5, 100), 0) << "whatever went before";
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
    kFreeSpace.carve(planes, Viewpoint(keyframe), 1);
    EXPECT_NEAR(shape_area(planes[0]), 1, 0.06);
    EXPECT_FALSE(planes[0].changed);
    EXPECT_EQ(planes[0].changed_cells, 0);
}

TEST(FreeSpace, TellsHowManyCellsWent) {
    std::vector<PlaneEstimate> planes{drawn_estimate_of(wall_at(0, 0, 2), 0)};
    planes[0].changed = false;
    planes[0].changed_cells = 0;
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), {wall_at(0, 0, 4, 3)});
    kFreeSpace.carve(planes, Viewpoint(keyframe), 1);
    EXPECT_TRUE(planes[0].changed);
    EXPECT_NEAR(planes[0].changed_cells, 1600, 90);
}

TEST(FreeSpace, BackInTimeSaysWhatOneAfterTheOtherDoes) {
    const Rectangle plate = wall_at(0.4, 0.3, 2, 0.8), wall = wall_at(0, 0, 4, 2.5);
    std::vector<StoredKeyframe> keyframes;
    for (int i = 0; i < 5; ++i) {
        keyframes.push_back(stored_at(scene::camera_at({0.1 * i, 0, 0}), {wall}));
        keyframes.back().seen_utime = 10 * (i + 1);
    }
    std::vector<PlaneEstimate> one_by_one{drawn_estimate_of(plate, 0, 2, 3)};
    for (const StoredKeyframe& keyframe : keyframes)
        kFreeSpace.carve(one_by_one, Viewpoint(keyframe), keyframe.looks);
    std::reverse(keyframes.begin(), keyframes.end());
    std::vector<Viewpoint> viewpoints;
    for (const StoredKeyframe& keyframe : keyframes) viewpoints.emplace_back(keyframe);
    PlaneEstimate back = drawn_estimate_of(plate, 0, 2, 3);
    kFreeSpace.look_back(back, {}, viewpoints);
    EXPECT_LT(shape_area(back), 2.5);
    EXPECT_NEAR(shape_area(back), shape_area(one_by_one[0]), 1e-9);
}

/// Area of a plate that `hits` looks saw, after `before` looks that saw past where it is and before `after`.
double area_between(int before, int hits, int after) {
    PlaneEstimate plane = drawn_estimate_of(wall_at(0, 0, 2), 0, 0, 0);
    StoredKeyframe early = stored_at(Pose::Identity(), {wall_at(0, 0, 4, 3)}), late = early;
    early.looks = before, early.seen_utime = 1;
    late.looks = after, late.seen_utime = 3;
    FlatPolygon polygon;
    polygon.assign(scene::outline_of(wall_at(0, 0, 2)));
    const SeenCells seen{2, hits, plane.grid.cells_of(polygon)};
    std::vector<Viewpoint> viewpoints;
    if (after > 0) viewpoints.emplace_back(late);
    if (before > 0) viewpoints.emplace_back(early);
    kFreeSpace.look_back(plane, {seen}, viewpoints);
    return shape_area(plane);
}

TEST(FreeSpace, WhatIsNewInFreeSpaceNeedsMoreLooksThanSawPastIt) {
    EXPECT_NEAR(area_between(0, 1, 0), 1, 0.06) << "nobody saw that space before";
    EXPECT_EQ(area_between(5, 1, 0), 0);
    EXPECT_EQ(area_between(2, 2, 0), 0);
    EXPECT_NEAR(area_between(2, 3, 0), 1, 0.06);
    EXPECT_NEAR(area_between(5, 5, 0), 1, 0.06) << "five looks tell";
    EXPECT_EQ(area_between(0, 2, 2), 0) << "gone again";
    EXPECT_NEAR(area_between(0, 5, 4), 1, 0.06);
    EXPECT_EQ(area_between(0, 5, 5), 0);
}

TEST(FreeSpace, OfNothing) {
    std::vector<PlaneEstimate> none, empty(1);
    const StoredKeyframe blind = stored_at(Pose::Identity(), {});
    kFreeSpace.carve(none, Viewpoint(blind), 1);
    kFreeSpace.carve(empty, Viewpoint(blind), 1);
    kFreeSpace.look_back(empty[0], {}, {});
    PlaneEstimate plane = drawn_estimate_of(wall_at(0, 0, 2), 0);
    kFreeSpace.look_back(plane, {}, {Viewpoint(blind)});
    EXPECT_NEAR(shape_area(plane), 1, 0.06);
}

}  // namespace
}  // namespace planemap::map
