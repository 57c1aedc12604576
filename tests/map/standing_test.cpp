// SPDX-License-Identifier: BSD-3-Clause
#include "map/standing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/furniture.hpp"
#include "core/geometry/angle.hpp"
#include "map/support.hpp"

namespace planemap::map {
namespace {

using scene::facing_down;
using scene::level;
using scene::Rectangle;
using scene::upright;

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
constexpr double kTolerance = radians(10);

/// A map and its planes about up; those of the map by id.
struct Stand {
    PlaneMap map;
    std::vector<Standing> planes;

    explicit Stand(const std::vector<Rectangle>& rectangles) : map(scene::map_of(rectangles)) {
        planes = standing_planes(map, kUp, kTolerance);
    }
    const Standing& of(int id) const {
        return *std::find_if(planes.begin(), planes.end(),
                             [&](const Standing& s) { return s.plane->id == id; });
    }
};

TEST(Standing, TellsHowPlanesLieAndHowHigh) {
    Rectangle ramp = level(0, 3, 1, 1, 1);
    ramp.world_from_face.rotate(Eigen::AngleAxisd(radians(40), Eigen::Vector3d::UnitX()));
    const Stand stand(
        {level(0, 0, 0, 3, 2), facing_down(level(0, 0, 2.5, 1, 1)), upright(2, 0, 0.5, 0, 1, 1.2), ramp});
    ASSERT_EQ(stand.planes.size(), 4u);
    EXPECT_EQ(stand.planes[0].plane->id, 0) << "the most supported first";
    EXPECT_EQ(stand.of(0).lie, Lie::kFacesUp);
    EXPECT_EQ(stand.of(1).lie, Lie::kFacesDown);
    EXPECT_EQ(stand.of(2).lie, Lie::kUpright);
    EXPECT_EQ(stand.of(3).lie, Lie::kOblique);
    EXPECT_TRUE(stand.of(1).is_level());
    EXPECT_FALSE(stand.of(2).is_level());
    EXPECT_NEAR(stand.of(1).height, 2.5, 1e-5);
    EXPECT_NEAR(stand.of(2).low, 0.5, 2e-3);
    EXPECT_NEAR(stand.of(2).high, 1.7, 2e-3);
    EXPECT_NEAR(stand.of(0).half_length(Eigen::Vector3d::UnitX()), 3, 1e-5);
    EXPECT_EQ(stand.of(0).support, supported_area(stand.map.planes[0]));
}

TEST(Standing, OfItsSupportAShareLiesBetweenHeights) {
    const Stand stand({upright(0, 0, 0, 0, 2, 2)});
    const Standing& wall = stand.planes[0];
    EXPECT_NEAR(wall.support_between(0.5, 1), 0.25 * wall.support, 1e-3 * wall.support);
    EXPECT_NEAR(wall.support_between(-1, 5), wall.support, 1e-3 * wall.support);
    EXPECT_EQ(wall.support_between(3, 4), 0);
}

TEST(Standing, WhatIsNoPlaneIsLeftOut) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    PlaneMap map = scene::map_of(std::vector<Rectangle>(7, level(0, 0, 0, 1, 1)));
    map.planes[0].normal = {0, 0, 1.01f};
    map.planes[1].normal.setZero();
    map.planes[2].center.x() = kNan;
    map.planes[3].half_extents.y() = kNan;
    map.planes[4].area = std::numeric_limits<float>::infinity();
    map.planes[5].angle = kNan;
    for (int i = 0; i < 6; ++i) EXPECT_FALSE(is_plane(map.planes[static_cast<std::size_t>(i)])) << i;
    const std::vector<Standing> planes = standing_planes(map, kUp, kTolerance);
    ASSERT_EQ(planes.size(), 1u);
    EXPECT_EQ(planes[0].plane, &map.planes[6]);
}

TEST(Standing, OverFurnitureAHigherPlaneIsSeenBehindIt) {
    // A cabinet half a metre before a wall, both seen from +x.
    const Stand stand({upright(0, 0, 0, 0, 4, 2.5), upright(0.5, 0, 0, 0, 1, 0.9)});
    EXPECT_TRUE(is_seen_over(stand.of(1), stand.planes, kUp));
    EXPECT_FALSE(is_seen_over(stand.of(0), stand.planes, kUp));
    const Stand doubled({upright(0, 0, 0, 0, 4, 2.5), upright(0.05, 0, 0, 0, 1, 0.9)});
    EXPECT_FALSE(is_seen_over(doubled.of(1), doubled.planes, kUp)) << "one wall in two places";
    const Stand far({upright(0, 0, 0, 0, 4, 2.5), upright(2, 0, 0, 0, 1, 0.9)});
    EXPECT_FALSE(is_seen_over(far.of(1), far.planes, kUp)) << "another room's";
    const Stand aside({upright(0, 0, 0, 0, 1, 2.5), upright(0.5, 3, 0, 0, 1, 0.9)});
    EXPECT_FALSE(is_seen_over(aside.of(1), aside.planes, kUp));
}

TEST(Standing, ACabinetHasATop) {
    // Its front at x = 0.5 faces +x, its top goes back to x = 0.
    const Stand stand({upright(0.5, 0, 0, 0, 1, 0.9), level(0.25, 0, 0.9, 0.25, 0.5)});
    EXPECT_TRUE(has_top(stand.of(0), stand.planes, kUp));
    const Stand before({upright(0.5, 0, 0, 0, 1, 0.9), level(1.2, 0, 0.9, 0.25, 0.5)});
    EXPECT_FALSE(has_top(before.of(0), before.planes, kUp)) << "a table before a wall";
    const Stand tall({upright(0.5, 0, 0, 0, 1, 2.4), level(0.25, 0, 2.4, 0.25, 0.5)});
    EXPECT_FALSE(has_top(tall.of(0), tall.planes, kUp)) << "nobody sees the top of that";
    const Stand from_below({upright(0.5, 0, 0, 0, 1, 0.9), facing_down(level(0.25, 0, 0.9, 0.25, 0.5))});
    EXPECT_FALSE(has_top(from_below.of(0), from_below.planes, kUp));
}

}  // namespace
}  // namespace planemap::map
