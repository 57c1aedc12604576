// SPDX-License-Identifier: BSD-3-Clause
#include "map/starting_planes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/scene.hpp"
#include "map/estimates.hpp"
#include "map/evidence_shape.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;

MapPlane level(int id, double z, double half, double step) {
    const Rectangle r{facing({0, 0, z}, {0, 0, 1}, {1, 0, 0}), half, half, {}};
    return {id, scene::region_of(r, Pose::Identity(), step), 10};
}

TEST(StartingPlanes, AreThoseOfTheMap) {
    PlaneMap map;
    for (int i = 0; i < 3; ++i) map.planes.push_back(level(10 * i, i, 0.5 + i, 0.05));
    const StartingPlanes start = starting_planes(map, 200, 0.025);
    ASSERT_EQ(start.planes.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(start.planes[i].id, map.planes[i].id);
        EXPECT_EQ(start.planes[i].grid.cell_m(), 0.025);
        EXPECT_NEAR(area(outline_of(start.planes[i].grid, samples::kOutline)),
                    static_cast<double>(map.planes[i].area), 0.2);
    }
    EXPECT_EQ(start.refused, 0u);
    EXPECT_EQ(start.coarsened, 0u);
}

TEST(StartingPlanes, OutOfRangeAreRefused) {
    PlaneMap map;
    map.planes.assign(6, level(0, 0, 1, 0.05));
    map.planes[0].id = -1;
    map.planes[1].id = std::numeric_limits<int>::max();
    map.planes[2].center.x() = 1e9f;
    map.planes[3].center.y() = std::numeric_limits<float>::quiet_NaN();
    map.planes[4].half_extents.setConstant(1e4f);
    const StartingPlanes start = starting_planes(map, 200, 0.025);
    EXPECT_EQ(start.refused, 5u);
    EXPECT_EQ(start.planes.size(), 1u);
}

TEST(StartingPlanes, LargeOnesShareTheRoomAndSmallOnesHaveWhatTheyNeed) {
    PlaneMap map;
    for (int i = 0; i < 30; ++i) map.planes.push_back(level(i, 4.0 * i, 100, 2));
    map.planes.push_back(level(30, 1, 0.5, 0.05));
    const StartingPlanes start = starting_planes(map, 300, 0.025);
    EXPECT_EQ(start.coarsened, 30u);
    std::size_t bytes = 0;
    for (const PlaneEstimate& plane : start.planes) {
        bytes += plane.grid.memory_bytes();
        EXPECT_EQ(plane.grid.cell_m() > 0.025, plane.id != 30);
    }
    EXPECT_LT(bytes, std::size_t{160} << 20) << "128 MB, and what rounding to words adds";
}

TEST(StartingPlanes, OfAnEmptyMap) {
    EXPECT_TRUE(starting_planes({}, 200, 0.025).planes.empty());
}

}  // namespace
}  // namespace planemap::map
