// SPDX-License-Identifier: BSD-3-Clause
#include "map/inference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <vector>

#include "core/scene.hpp"
#include "map/inferred_parts.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;

// A room of 4 x 2.4 m, seen from its middle: x right, y down, z ahead. The wall is 3 m ahead, the floor 1.2 m
// below; a cupboard of 1 x 1.4 m stands half a metre before the wall and hides the wall from 1.2 x 1.44 m on.
constexpr int kWall = 1, kFloor = 2, kSide = 3, kCupboard = 4;
const Rectangle kFront{facing({0, 0.5, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.7, {}};
const Rectangle kWholeWall{facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 2, 1.2, {}};
const Rectangle kWholeFloor{facing({0, 1.2, 2.5}, {0, -1, 0}, {1, 0, 0}), 2, 0.5, {}};  // in view

MapPlane map_plane(int id, PlaneLabel label, const Pose& world_from_face, const Outline& outline) {
    const Rectangle face{world_from_face, 2, 2, {}};
    PlanarRegion region = scene::region_of(face, Pose::Identity(), 0.2);
    region.outline = outline;
    MapPlane plane(id, region, 5);
    plane.label = label;
    return plane;
}

/// What is seen of the wall; y of its face goes up.
Outline wall_outline() {
    return {
        {{{-2, -1.2}, {-0.6, -1.2}, {-0.6, 0.24}, {0.6, 0.24}, {0.6, -1.2}, {2, -1.2}, {2, 1.2}, {-2, 1.2}}}};
}

/// A map's planes and what cameras see of the whole things; the nearest is seen.
struct Room {
    PlaneMap map;
    std::list<StoredKeyframe> keyframes;
    std::vector<Viewpoint> views;

    Room() {
        map.up = {0, -1, 0};
        const Pose wall = facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0});
        map.planes.push_back(map_plane(kWall, PlaneLabel::kWall, wall, wall_outline()));
        const Pose floor = facing({0, 1.2, 1.5}, {0, -1, 0}, {1, 0, 0});
        map.planes.push_back(map_plane(
            kFloor, PlaneLabel::kFloor, floor,
            {{{{-2, -1.5}, {2, -1.5}, {2, 1.5}, {0.6, 1.5}, {0.6, 1}, {-0.6, 1}, {-0.6, 1.5}, {-2, 1.5}}}}));
    }
    struct Thing {
        int plane;
        Rectangle rectangle;
    };
    void look(const std::vector<Thing>& things, const Eigen::Vector3d& from = {0, 0, 0}) {
        const Pose world_from_camera = scene::camera_at(from);
        std::vector<PlanarRegion> regions;
        for (const Thing& thing : things)
            regions.push_back(scene::region_of(thing.rectangle, world_from_camera, 0.1));
        StoredKeyframe& keyframe = keyframes.emplace_back(stored(1000, regions));
        for (std::size_t i = 0; i < things.size(); ++i) keyframe.regions[i].plane = things[i].plane;
        keyframe.world_from_camera = world_from_camera;
        views.emplace_back(keyframe);
    }
    void look_at_all() { look({{kWall, kWholeWall}, {kFloor, kWholeFloor}, {kCupboard, kFront}}); }

    std::map<int, InferredCells> infer(const std::map<int, PlanePart>& told = {}) const {
        return Inference(map, views, told, 0.025).infer();
    }
    double area(int plane) const {
        const auto inferred = infer();
        const auto at = inferred.find(plane);
        return at == inferred.end() ? 0 : area(at->second);
    }
    static double area(const InferredCells& cells) {
        return static_cast<double>(cells.cells.count()) * cells.cell_m * cells.cell_m;
    }
};

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

TEST(InferredParts, CountInNoAreaAndGoWhereTheyAreSeen) {
    Room room;
    room.look_at_all();
    const float area = room.map.planes[0].area;
    InferredParts parts(InferenceRules{});
    parts.infer(room.map, room.views);
    ASSERT_NE(room.map.inferred_of(kWall), nullptr);
    EXPECT_EQ(room.map.planes[0].area, area);
    const Outline outline = room.map.inferred_of(kWall)->rings();
    EXPECT_NEAR(planemap::area(outline), 1.2 * 1.44, 0.1);
    EXPECT_LE(outline.vertex_count(), 8u) << "straight edges";

    // The cupboard is pulled aside, and half of the wall behind it comes into view.
    const Outline more{
        {{{-2, -1.2}, {0, -1.2}, {0, 0.24}, {0.6, 0.24}, {0.6, -1.2}, {2, -1.2}, {2, 1.2}, {-2, 1.2}}}};
    room.map.planes[0] = map_plane(kWall, PlaneLabel::kWall, facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), more);
    parts.update(room.map, {kWall});
    EXPECT_NEAR(planemap::area(room.map.inferred_of(kWall)->rings()), 0.6 * 1.44, 0.1);
    room.map.planes.erase(room.map.planes.begin());
    parts.update(room.map, {kWall});
    EXPECT_EQ(room.map.inferred_of(kWall), nullptr);
    EXPECT_NE(room.map.inferred_of(kFloor), nullptr);
}

TEST(InferredParts, OfAMapToStartFromStayUntilSomebodySeesPastThem) {
    Room room;
    room.look_at_all();
    InferredParts before(InferenceRules{});
    before.infer(room.map, room.views);
    const double area = planemap::area(room.map.inferred_of(kWall)->rings());

    InferredParts parts(InferenceRules{});
    parts.start_from(room.map);
    parts.infer(room.map, {});
    ASSERT_NE(room.map.inferred_of(kWall), nullptr);
    EXPECT_NEAR(planemap::area(room.map.inferred_of(kWall)->rings()), area, 0.05);
    Room later;
    later.look({{9, {facing({0, 0, 6}, {0, 0, -1}, {1, 0, 0}), 4, 4, {}}}});
    parts.infer(room.map, later.views);
    EXPECT_EQ(room.map.inferred_of(kWall), nullptr);

    InferredParts off(InferenceRules{.infers = false});
    off.start_from(room.map);
    off.infer(room.map, room.views);
    EXPECT_TRUE(room.map.inferred.empty());
}

TEST(InferredParts, HugePlanesAndPartsTakeBoundedMemory) {
    Room room;
    room.look_at_all();
    room.map.planes[1] = map_plane(kFloor, PlaneLabel::kFloor, facing({0, 1.2, 0}, {0, -1, 0}, {1, 0, 0}),
                                   {{scene::rectangle_ring(-30000, -30000, 30000, 30000)}});
    room.map.inferred = {{kWall, MapOutline({{scene::rectangle_ring(-30000, -30000, 30000, 30000)}})}};
    InferredParts parts(InferenceRules{});
    parts.start_from(room.map);
    parts.infer(room.map, room.views);
    EXPECT_LT(parts.memory_bytes(), std::size_t{64} << 20);
}

}  // namespace
}  // namespace planemap::map
