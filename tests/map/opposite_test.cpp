// SPDX-License-Identifier: BSD-3-Clause
#include "map/opposite.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/furniture.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

using scene::level;
using scene::Rectangle;

MapPlane plane_of(const Rectangle& rectangle) {
    return scene::map_of({rectangle}).planes[0];
}

Opposite of(const Rectangle& a, const Rectangle& b, const Eigen::Vector3d& along) {
    return opposite_of(plane_of(a), plane_of(b), along);
}

TEST(Opposite, IsWhatBothOutlinesHoldSeenAlongADirection) {
    // A floor and a table over its corner: 0.5 x 0.25 m of both.
    const Opposite opposite =
        of(level(0, 0, 0, 1, 1), level(1, 1, 0.75, 0.5, 0.25), Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(opposite.area(), 0.5 * 0.25, 0.004);
    EXPECT_GT(opposite.cells.size(), 5000u);
    EXPECT_LE(opposite.cells.size(), 10500u);
    EXPECT_LT((opposite.middle() - Eigen::Vector3d(0.75, 0.875, 0)).norm(), 0.01);
    for (const Eigen::Vector2d& cell : {opposite.cells.front(), opposite.cells.back()})
        EXPECT_NEAR(opposite.in_world(cell).z(), 0, 1e-6) << "on the first plane";
}

TEST(Opposite, HolesAreOppositeOfNothing) {
    Rectangle floor = level(0, 0, 0, 1, 1);
    floor.holes = {scene::rectangle_ring(-0.5, -0.5, 0.5, 0.5)};
    EXPECT_NEAR(of(floor, level(0, 0, 1, 1, 1), Eigen::Vector3d::UnitZ()).area(), 3, 0.06);
    EXPECT_TRUE(of(floor, level(0, 0, 1, 0.4, 0.4), Eigen::Vector3d::UnitZ()).cells.empty());
}

TEST(Opposite, IsSymmetricInAnyWorld) {
    test::Random random(8);
    for (int i = 0; i < 10; ++i) {
        const Pose world = random.pose();
        const PlaneMap map = scene::map_of({level(0, 0, 0, 1, 1), level(0.7, 0.2, 2, 0.6, 1.5)}, world);
        const Eigen::Vector3d along = world.linear().col(2);
        const double area = opposite_of(map.planes[0], map.planes[1], along).area();
        EXPECT_NEAR(area, 0.9 * 2, 0.05);
        EXPECT_NEAR(opposite_of(map.planes[1], map.planes[0], along).area(), area, 0.05);
    }
}

TEST(Opposite, NothingOfWhatLiesAsideOrIsNotFinite) {
    EXPECT_TRUE(of(level(0, 0, 0, 1, 1), level(3, 0, 1, 1, 1), Eigen::Vector3d::UnitZ()).cells.empty());
    MapPlane bad = plane_of(level(0, 0, 1, 1, 1));
    bad.outline.unit = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(opposite_of(plane_of(level(0, 0, 0, 1, 1)), bad, Eigen::Vector3d::UnitZ()).cells.empty());
    bad.outline = {};
    EXPECT_TRUE(opposite_of(bad, plane_of(level(0, 0, 0, 1, 1)), Eigen::Vector3d::UnitZ()).cells.empty());
}

TEST(Opposite, OfALongStripTheCellsAreBounded) {
    const Rectangle strip = level(0, 0, 0, 15, 0.11), over = level(0, 0, 1, 15, 0.11);
    const Opposite opposite = of(strip, over, Eigen::Vector3d::UnitZ());
    EXPECT_GT(opposite.cells.size(), 9000u);
    EXPECT_LT(opposite.cells.size(), 11000u);
    EXPECT_NEAR(opposite.area(), 30 * 0.22, 0.5);
}

}  // namespace
}  // namespace planemap::map
