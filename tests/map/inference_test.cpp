// SPDX-License-Identifier: BSD-3-Clause
#include "map/inference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "map/hidden_wall.hpp"

namespace planemap::map {
namespace {

using samples::kCupboard;
using samples::kFloor;
using samples::kFront;
using samples::kSide;
using samples::kWall;
using samples::kWholeFloor;
using samples::kWholeWall;
using samples::map_plane;
using samples::Room;
using scene::facing;
using scene::Rectangle;

/// Whether a place of the world, on the plane, is inferred.
bool holds(const std::map<int, InferredCells>& inferred, int plane, const Eigen::Vector3d& p_world) {
    const auto at = inferred.find(plane);
    if (at == inferred.end()) return false;
    const Eigen::Vector3d p = at->second.world_from_raster.inverse(Eigen::Isometry) * p_world;
    const double cell = at->second.cell_m;
    return at->second.cells.at(static_cast<int>(std::floor(p.x() / cell)),
                               static_cast<int>(std::floor(p.y() / cell)));
}

TEST(Inference, WallAndFloorGoOnBehindACupboardUpToTheirLine) {
    Room room;
    room.look_at_all();
    const auto inferred = room.infer();
    ASSERT_EQ(inferred.size(), 2u);
    EXPECT_NEAR(Room::area(inferred.at(kWall)), 1.2 * 1.44, 0.1);
    EXPECT_NEAR(Room::area(inferred.at(kFloor)), 1.2 * 0.5, 0.1);
    for (const double x : {-0.5, 0.0, 0.5}) {
        EXPECT_TRUE(holds(inferred, kWall, {x, 1.15, 3}));
        EXPECT_FALSE(holds(inferred, kWall, {x, 1.25, 3})) << "beyond the line";
        EXPECT_TRUE(holds(inferred, kFloor, {x, 1.2, 2.95}));
        EXPECT_FALSE(holds(inferred, kFloor, {x, 1.2, 3.05})) << "beyond the line";
    }
    EXPECT_FALSE(holds(inferred, kWall, {1.5, 0, 3})) << "what is seen is not inferred";
}

TEST(Inference, WhatSomebodyLookedThroughStaysOpen) {
    Room room;
    room.look_at_all();
    // From aside, a window behind the cupboard: a house beyond is seen in it.
    const Rectangle house{facing({0, 0.5, 6}, {0, 0, -1}, {1, 0, 0}), 3, 0.5, {}};
    room.look({{9, house}}, {0, -0.3, 1});
    const auto inferred = room.infer();
    EXPECT_FALSE(holds(inferred, kWall, {0, 0, 3}));
    EXPECT_TRUE(holds(inferred, kWall, {0, 1, 3})) << "but not below";
}

TEST(Inference, AHoleThatNothingHidesIsNoWall) {
    Room room;
    Rectangle wall = kWholeWall;
    wall.holes = {scene::rectangle_ring(-0.6, -1.2, 0.6, 0.24)};
    room.look({{kWall, wall}, {kFloor, kWholeFloor}});
    EXPECT_TRUE(room.infer().empty()) << "a window through which nothing is seen";
    room.views.clear();
    EXPECT_TRUE(room.infer().empty()) << "nobody looked";
}

TEST(Inference, AWallWhoseEndNobodySawEndsWhereItIsSeen) {
    Room room;
    room.map.planes.resize(1);
    room.map.planes[0] = map_plane(kWall, PlaneLabel::kWall, facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}),
                                   {{{{-2, -1.2}, {-0.6, -1.2}, {-0.6, 1.2}, {-2, 1.2}}}});
    const Rectangle tall{facing({0, 0, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.5, 1.2, {}};
    room.look({{kWall, kWholeWall}, {kCupboard, tall}});
    EXPECT_TRUE(room.infer().empty());

    // Another wall beside the cupboard: both go on to where they meet.
    room.map.planes.push_back(map_plane(kSide, PlaneLabel::kWall, facing({0.4, 0, 2}, {-1, 0, 0}, {0, 0, 1}),
                                        {{{{-1, -1.2}, {0.4, -1.2}, {0.4, 1.2}, {-1, 1.2}}}}));
    const Rectangle side{facing({0.4, 0, 1.75}, {-1, 0, 0}, {0, 0, 1}), 0.7, 1.2, {}};
    room.keyframes.clear();
    room.views.clear();
    room.look({{kWall, kWholeWall}, {kCupboard, tall}, {kSide, side}});
    const auto inferred = room.infer();
    EXPECT_TRUE(holds(inferred, kWall, {0, 0, 3}));
    EXPECT_FALSE(holds(inferred, kWall, {0.5, 0, 3})) << "beyond the line";
}

TEST(Inference, WhatBoundsTheRoomHidesNothing) {
    Room room;
    room.map.planes.push_back(
        map_plane(kCupboard, PlaneLabel::kWall, kFront.world_from_face, scene::outline_of(kFront)));
    room.look_at_all();
    EXPECT_TRUE(room.infer().empty());
    room.map.planes.back().label = PlaneLabel::kVertical;
    EXPECT_FALSE(room.infer().empty());
    room.map.up.setZero();
    EXPECT_TRUE(room.infer().empty()) << "which way is up is not known";
}

TEST(Inference, TheOrderOfViewsIsNoMatter) {
    Room room;
    room.look_at_all();
    room.look({{kWall, kWholeWall}, {kFloor, kWholeFloor}, {kCupboard, kFront}}, {0.5, 0.1, 0.2});
    room.look({{kWall, kWholeWall}, {kCupboard, kFront}}, {-0.7, 0, 0.4});
    const auto inferred = room.infer();
    std::reverse(room.views.begin(), room.views.end());
    const auto reversed = room.infer();
    ASSERT_EQ(inferred.size(), reversed.size());
    for (const auto& [id, cells] : inferred) {
        Bitmap difference = cells.cells;
        difference &= reversed.at(id).cells;
        EXPECT_EQ(difference.count(), cells.cells.count());
        EXPECT_EQ(reversed.at(id).cells.count(), cells.cells.count());
    }
}

}  // namespace
}  // namespace planemap::map
