// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/plane_matching.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "exports/corner.hpp"

namespace planemap::evaluation {
namespace {

using scene::facing;
using scene::plane_of;
using testing::ElementsAre;
using testing::IsEmpty;

PlaneMap wall_at(double x, int id = 3) {
    PlaneMap map;
    map.planes = {plane_of(id, {facing({x, 0, 1}, {-1, 0, 0}, {0, 1, 0}), 1, 1, {}})};
    return map;
}

TEST(PlaneMatching, AMapMatchesItselfWhateverItsIds) {
    PlaneMap a = scene::corner(), b = scene::corner();
    for (MapPlane& plane : b.planes) plane.id += 100;
    const PlaneMatches matches = match_planes(a, b);
    ASSERT_EQ(matches.pairs.size(), 3U);
    for (const PlaneMatch& pair : matches.pairs) {
        EXPECT_EQ(pair.b, pair.a + 100);
        EXPECT_NEAR(pair.offset_m, 0, 1e-6);
        EXPECT_TRUE(pair.is_in_place());
    }
    EXPECT_THAT(matches.only_a, IsEmpty());
    EXPECT_THAT(matches.only_b, IsEmpty());
}

TEST(PlaneMatching, APlaneMovesByAsMuchAsItMoved) {
    const PlaneMatches matches = match_planes(wall_at(2), wall_at(2.1, 8));
    ASSERT_EQ(matches.pairs.size(), 1U);
    EXPECT_NEAR(matches.pairs[0].offset_m, -0.1, 1e-4) << "along the normal, which points to -x";
    EXPECT_FALSE(matches.pairs[0].is_in_place());
    EXPECT_NEAR(match_planes(wall_at(2.1), wall_at(2)).pairs.at(0).offset_m, 0.1, 1e-4);
}

TEST(PlaneMatching, FarTurnedOrElsewhereIsAnotherPlane) {
    EXPECT_THAT(match_planes(wall_at(2), wall_at(2.6)).pairs, IsEmpty());
    PlaneMap turned, beside, back;
    turned.planes = {plane_of(1, {facing({2, 0, 1}, {-1, -0.5, 0}, {0, 0, 1}), 1, 1, {}})};
    beside.planes = {plane_of(1, {facing({2, 1.9, 1}, {-1, 0, 0}, {0, 1, 0}), 1, 1, {}})};
    back.planes = {plane_of(1, {facing({2, 0, 1}, {1, 0, 0}, {0, 1, 0}), 1, 1, {}})};
    for (const PlaneMap& other : {turned, beside, back}) {
        const PlaneMatches matches = match_planes(wall_at(2), other);
        EXPECT_THAT(matches.pairs, IsEmpty());
        EXPECT_THAT(matches.only_a, ElementsAre(3));
        EXPECT_THAT(matches.only_b, ElementsAre(1));
        EXPECT_THAT(matches.on_a, ElementsAre(-1));
    }
}

TEST(PlaneMatching, TheNearerOfTwoMatchesAndASplitOffPartSaysOfWhat) {
    PlaneMap two = wall_at(2, 5);
    two.planes.push_back(wall_at(2.2, 6).planes[0]);
    EXPECT_EQ(match_planes(wall_at(2.15), two).pairs.at(0).b, 6);
    PlaneMap parts;
    parts.planes = {plane_of(1, {facing({2, -0.5, 1}, {-1, 0, 0}, {0, 1, 0}), 0.5, 1, {}}),
                    plane_of(2, {facing({2, 0.5, 1}, {-1, 0, 0}, {0, 1, 0}), 0.5, 1, {}})};
    const PlaneMatches matches = match_planes(wall_at(2), parts);
    ASSERT_EQ(matches.pairs.size(), 1U);
    EXPECT_EQ(matches.only_b.size(), 1U);
    EXPECT_THAT(matches.on_a, ElementsAre(3));
}

TEST(PlaneMatching, EmptyMapsAndPlanesThatAreNotFiniteMatchNothing) {
    EXPECT_THAT(match_planes({}, {}).pairs, IsEmpty());
    PlaneMap broken = wall_at(2);
    broken.planes[0].center.x() = std::numeric_limits<float>::quiet_NaN();
    broken.planes.emplace_back();  // no outline
    const PlaneMatches matches = match_planes(broken, wall_at(2));
    EXPECT_THAT(matches.pairs, IsEmpty());
    EXPECT_EQ(matches.only_a.size(), 2U);
}

}  // namespace
}  // namespace planemap::evaluation
