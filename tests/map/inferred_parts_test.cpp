// SPDX-License-Identifier: BSD-3-Clause
#include "map/inferred_parts.hpp"

#include <gtest/gtest.h>

#include "map/hidden_wall.hpp"
#include "map/rules.hpp"

namespace planemap::map {
namespace {

using samples::kFloor;
using samples::kWall;
using samples::map_plane;
using samples::Room;
using scene::facing;

TEST(InferredParts, CountInNoAreaAndGoWhereTheyAreSeen) {
    Room room;
    room.look_at_all();
    const float area = room.map.planes[0].area;
    InferredParts parts(inference_rules({}));
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
    InferredParts before(inference_rules({}));
    before.infer(room.map, room.views);
    const double area = planemap::area(room.map.inferred_of(kWall)->rings());

    InferredParts parts(inference_rules({}));
    parts.start_from(room.map);
    parts.infer(room.map, {});
    ASSERT_NE(room.map.inferred_of(kWall), nullptr);
    EXPECT_NEAR(planemap::area(room.map.inferred_of(kWall)->rings()), area, 0.05);
    Room later;
    later.look({{9, {facing({0, 0, 6}, {0, 0, -1}, {1, 0, 0}), 4, 4, {}}}});
    parts.infer(room.map, later.views);
    EXPECT_EQ(room.map.inferred_of(kWall), nullptr);

    InferenceRules none = inference_rules({});
    none.infers = false;
    InferredParts off(none);
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
    InferredParts parts(inference_rules({}));
    parts.start_from(room.map);
    parts.infer(room.map, room.views);
    EXPECT_LT(parts.memory_bytes(), std::size_t{64} << 20);
}

}  // namespace
}  // namespace planemap::map
