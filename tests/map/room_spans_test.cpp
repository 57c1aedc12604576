// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/furniture.hpp"
#include "core/random_values.hpp"
#include "map/relation.hpp"

namespace planemap::map {
namespace {

using Kind = RoomSpan::Kind;
using scene::level;
using scene::upright;

constexpr double kPi = std::numbers::pi;

/// A room of 6 x 5 x 2.7 m, and behind the wall x = 6, which is 0.12 m thick, a corridor of 2 m with its
/// other wall. Walls 0 to 3 are the room's (x = 0, x = 6, y = 0, y = 5), 4 and 5 the corridor's, 6 floor, 7
/// ceiling.
PlaneMap room(const Pose& world_from_room = Pose::Identity()) {
    PlaneMap map = scene::map_of({upright(0, 2.5, 0, 0, 5, 2.7), upright(6, 2.5, 0, kPi, 5, 2.7),
                                  upright(3, 0, 0, kPi / 2, 6, 2.7), upright(3, 5, 0, -kPi / 2, 6, 2.7),
                                  upright(6.12, 2.5, 0, 0, 5, 2.7), upright(8.12, 2.5, 0, kPi, 5, 2.7),
                                  level(3, 2.5, 0, 3, 2.5), scene::facing_down(level(3, 2.5, 2.7, 3, 2.5))},
                                 world_from_room);
    for (MapPlane& plane : map.planes) plane.label = PlaneLabel::kWall;
    map.planes[6].label = PlaneLabel::kFloor;
    map.planes[7].label = PlaneLabel::kCeiling;
    return map;
}

/// "kind a b" of each.
std::vector<std::string> names(const PlaneMap& map) {
    std::vector<std::string> found;
    for (const RoomSpan& span : room_spans(map))
        found.push_back(std::string(kind_name(span.kind)) + " " + std::to_string(span.a) + " " +
                        std::to_string(span.b));
    return found;
}

TEST(RoomSpans, AreWhatATapeMeasures) {
    test::Random random(4);
    for (int i = 0; i < 5; ++i) {
        const PlaneMap map = room(random.pose(10));
        EXPECT_THAT(names(map),
                    testing::ElementsAre("floor to ceiling 6 7", "wall to wall 0 1", "wall to wall 2 3",
                                         "wall to wall 4 5", "wall thickness 1 4"));
        const std::vector<RoomSpan> spans = room_spans(map);
        const std::vector<double> truth{2.7, 6.0, 5.0, 2.0, 0.12};
        for (std::size_t k = 0; k < spans.size(); ++k)
            EXPECT_NEAR(spans[k].relation.distance.value(), truth[k], 2e-3);
    }
}

TEST(RoomSpans, FurnitureAndSmallPiecesDoNotDivideARoom) {
    PlaneMap map = room();
    MapPlane cupboard = scene::map_of({upright(0.6, 2.5, 0, 0, 2, 2)}).planes[0];
    cupboard.id = 8;
    cupboard.label = PlaneLabel::kVertical;
    MapPlane pillar = scene::map_of({upright(3, 1, 0, kPi, 0.5, 2.7)}).planes[0];
    pillar.id = 9;
    pillar.label = PlaneLabel::kWall;
    map.planes.insert(map.planes.end(), {cupboard, pillar});
    EXPECT_THAT(names(map), testing::Contains("wall to wall 0 1"));
    EXPECT_THAT(names(map), testing::Contains("wall to wall 0 9"));
}

TEST(RoomSpans, OfMapsWithoutRooms) {
    EXPECT_TRUE(room_spans({}).empty());
    PlaneMap unknown = room();
    for (MapPlane& plane : unknown.planes) plane.label = PlaneLabel::kUnknown;
    EXPECT_TRUE(room_spans(unknown).empty());
    PlaneMap broken = room();
    for (MapPlane& plane : broken.planes) plane.normal.setConstant(std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(room_spans(broken).empty());
    PlaneMap bare = room();
    for (MapPlane& plane : bare.planes) plane.outline = {};
    EXPECT_TRUE(room_spans(bare).empty());
}

}  // namespace
}  // namespace planemap::map
