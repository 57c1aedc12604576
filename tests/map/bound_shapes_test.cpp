// SPDX-License-Identifier: BSD-3-Clause
#include "map/bound_shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/furniture.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

using scene::level;
using scene::Rectangle;

constexpr double kCell_m = 0.025;

/// A room of 6 x 4 m with a table, labelled: walls 0 to 3, floor 4, table 5.
PlaneMap room(const Pose& world = Pose::Identity()) {
    std::vector<Rectangle> planes = scene::walls(3, 2);
    planes.push_back(level(0, 0, 0, 3, 2));
    planes.push_back(level(1, 0, 0.75, 0.5, 0.5));
    PlaneMap map = scene::map_of(planes, world);
    map.up = (world.linear().col(2)).cast<float>();
    for (std::size_t i = 0; i < 4; ++i) map.planes[i].label = PlaneLabel::kWall;
    map.planes[4].label = PlaneLabel::kFloor;
    map.planes[5].label = PlaneLabel::kHorizontal;
    return map;
}

TEST(BoundShapes, AreTheFloorsCeilingsAndWallsWithTheirOutlines) {
    test::Random random(4);
    for (const Pose& world : {Pose::Identity(), random.pose(), random.pose()}) {
        const PlaneMap map = room(world);
        double cell_m = kCell_m;
        const std::vector<BoundShape> shapes = bound_shapes(map, cell_m);
        EXPECT_EQ(cell_m, kCell_m);
        ASSERT_EQ(shapes.size(), 5u) << "without the table";
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const BoundShape& shape = shapes[i];
            EXPECT_EQ(shape.id, map.planes[i].id);
            const double area = static_cast<double>(shape.seen.count()) * kCell_m * kCell_m;
            EXPECT_NEAR(area, map.planes[i].area, 0.4);
            EXPECT_LT(angle_between(shape.world_from_raster.linear().col(2), shape.plane.normal), 1e-6);
            EXPECT_NEAR((shape.world_from_raster * shape.raster_from_world).matrix().trace(), 4, 1e-9);
            const double up = shape.world_from_raster.linear().col(1).dot(world.linear().col(2));
            if (i < 4) {
                EXPECT_GT(up, 0.999);
            }
        }
    }
}

TEST(BoundShapes, EachLiesBeforeThoseThatItMeets) {
    const PlaneMap map = room();
    double cell_m = kCell_m;
    const std::vector<BoundShape> shapes = bound_shapes(map, cell_m);
    const BoundShape& floor = shapes[4];
    ASSERT_EQ(floor.before.size(), 4u) << "all walls";
    for (const HalfPlane& half : floor.before) {
        EXPECT_NEAR(half.normal.norm(), 1, 1e-9);
        EXPECT_GT(half.inside({0, 0}), 1.9) << "the middle of the room is inside";
        const Eigen::Vector3d behind =
            map.planes[half.other].center.cast<double>() - 0.5 * shapes[half.other].plane.normal;
        EXPECT_NEAR(half.inside((floor.raster_from_world * behind).head<2>()), -0.5, 1e-3);
    }
    EXPECT_TRUE(std::none_of(shapes[0].before.begin(), shapes[0].before.end(), [](const HalfPlane& half) {
        return half.other == 1;
    })) << "the wall opposite is parallel";
}

TEST(BoundShapes, TheirRastersReachAsFarAsTheRoomDoes) {
    PlaneMap map = room();
    double cell_m = kCell_m;
    const std::vector<BoundShape> shapes = bound_shapes(map, cell_m);
    const Bitmap cells = shapes[4].no_cells();
    EXPECT_EQ(cells.count(), 0u);
    EXPECT_EQ(cells.rows(), kCellsOfBlock * shapes[4].range.height());
    // Its x is along the normal of the largest wall.
    EXPECT_NEAR(shapes[4].range.width() * kCellsOfBlock * kCell_m, 4, 0.5);
    EXPECT_NEAR(shapes[4].range.height() * kCellsOfBlock * kCell_m, 6, 0.5);

    // A hall that no raster of such cells could hold.
    map.planes[4] = MapPlane(4, scene::region_of(level(0, 0, 0, 15000, 15000), Pose::Identity(), 500), 3);
    map.planes[4].label = PlaneLabel::kFloor;
    bound_shapes(map, cell_m);
    EXPECT_GT(cell_m, kCell_m);
}

TEST(BoundShapes, NoneWhereUpIsNotKnown) {
    PlaneMap map = room();
    map.up.setZero();
    double cell_m = kCell_m;
    EXPECT_TRUE(bound_shapes(map, cell_m).empty());
    EXPECT_TRUE(bound_shapes(PlaneMap(), cell_m).empty());
}

TEST(BoundShapes, AnOutlineIsDrawnWhereItLiesInTheRaster) {
    Bitmap cells(-1, -64, 2, 128);
    Pose raster_from_outline = Pose::Identity();
    raster_from_outline.translation() << 0.25, -0.5, 3;
    draw(Outline{{scene::rectangle_ring(0, 0, 0.5, 0.25)}}, raster_from_outline, kCell_m, cells);
    EXPECT_EQ(cells.count(), 200u);
    EXPECT_TRUE(cells.at(10, -20));
    EXPECT_TRUE(cells.at(29, -11));
    EXPECT_FALSE(cells.at(9, -20));
    EXPECT_FALSE(cells.at(30, -11));
}

}  // namespace
}  // namespace planemap::map
