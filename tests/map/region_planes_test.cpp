// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_planes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;
using ::testing::ElementsAre;

const Rectangle kWall{facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.8, {}};
const Rectangle kPlate{facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 0.3, 0.3, {}};

/// Keyframes 0 and 1 that see a plate and the wall behind it, and 2, which waits for its pose.
KeyframeStore store() {
    KeyframeStore keyframes(200);
    MapLosses losses;
    for (int id = 0; id < 3; ++id)
        keyframes.add(scene::keyframe(id, {kPlate, kWall}, Pose::Identity()), losses);
    for (int id = 0; id < 2; ++id) keyframes.set_pose(id, Pose::Identity());
    keyframes.place_all();
    return keyframes;
}

/// Gives a keyframe's regions planes, by their numbers.
void put(KeyframeStore& keyframes, int id, const std::vector<int>& planes) {
    for (StoredRegion& region : keyframes.keyframes().at(id).regions)
        region.plane = planes[static_cast<std::size_t>(region.number)];
}

TEST(RegionPlanes, AreToldByTheRegionsOwnNumbers) {
    KeyframeStore keyframes = store();
    put(keyframes, 0, {4, 7});
    put(keyframes, 1, {-1, 7});
    EXPECT_EQ(keyframes.keyframes().at(0).regions[0].number, 1) << "the wall, which is larger, comes first";
    const Surfaces surfaces = surfaces_of(keyframes, 123);
    EXPECT_EQ(surfaces.utime, 123);
    ASSERT_EQ(surfaces.keyframes.size(), 2u) << "without the one that waits";
    EXPECT_EQ(surfaces.keyframes[0].id, 0);
    EXPECT_THAT(surfaces.keyframes[0].planes, ElementsAre(4, 7));
    EXPECT_THAT(surfaces.keyframes[1].planes, ElementsAre(-1, 7));
    EXPECT_TRUE(surfaces_of(KeyframeStore(200), 0).keyframes.empty());
}

TEST(RegionPlanes, RecalledTheyAreWhatWasTold) {
    KeyframeStore told = store(), keyframes = store();
    put(told, 0, {4, 7});
    put(told, 1, {5, 7});
    put(keyframes, 0, {0, 1});
    put(keyframes, 1, {0, 1});
    Planes planes((MapOptions()));
    Surfaces surfaces = surfaces_of(told, 0);
    surfaces.keyframes[1].planes.pop_back();
    surfaces.keyframes.push_back({99, {1}});
    recall_surfaces(surfaces, keyframes, planes);
    const Surfaces again = surfaces_of(keyframes, 0);
    EXPECT_THAT(again.keyframes[0].planes, ElementsAre(4, 7));
    EXPECT_THAT(again.keyframes[1].planes, ElementsAre(5, -1)) << "of a region that was not named";
}

TEST(RegionPlanes, RecalledIdsAreNoNewPlanes) {
    KeyframeStore keyframes = store();
    Planes planes((MapOptions()));
    recall_surfaces({0, {{0, {12, -1}}}}, keyframes, planes);
    planes.rebuild(keyframes);
    ASSERT_EQ(planes.estimates().size(), 2u);
    std::vector<int> ids{planes.estimates()[0].id, planes.estimates()[1].id};
    std::sort(ids.begin(), ids.end());
    EXPECT_THAT(ids, ElementsAre(12, 13));
}

}  // namespace
}  // namespace planemap::map
