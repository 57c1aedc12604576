// SPDX-License-Identifier: BSD-3-Clause
#include "map/keyframe_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "core/scene.hpp"
#include "heap.hpp"

namespace planemap::map {
namespace {

using scene::camera_at;
using scene::facing;
using scene::Rectangle;
using ::testing::ElementsAre;
using Arrival = KeyframeStore::Arrival;

constexpr KeyframeStore::MotionLimits kLimits{0.002, 0.001};
const Rectangle kWall{facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.8, {}};

Keyframe seen_by(int id) {
    return scene::keyframe(id, {kWall}, Pose::Identity());
}

std::vector<KeyframePose> poses(const std::vector<int>& ids, double x = 0) {
    std::vector<KeyframePose> named;
    for (const int id : ids) named.push_back({id, 0, camera_at({x + 0.1 * id, 0, 0})});
    return named;
}

/// A store with these keyframes in the map.
KeyframeStore placed(const std::vector<int>& ids) {
    KeyframeStore store(200);
    MapLosses losses;
    for (const int id : ids) store.add(seen_by(id), losses);
    store.update(poses(ids), kLimits, losses);
    store.place_all();
    return store;
}

TEST(KeyframeStore, AKeyframeIsPlacedOnceBothItAndItsPoseAreThere) {
    MapLosses losses;
    KeyframeStore pose_first(200), keyframe_first(200);
    pose_first.set_pose(3, camera_at({1, 0, 0}));
    EXPECT_EQ(pose_first.place(3), nullptr);
    EXPECT_EQ(pose_first.add(seen_by(3), losses), Arrival::kNew);
    EXPECT_EQ(keyframe_first.add(seen_by(3), losses), Arrival::kNew);
    EXPECT_EQ(keyframe_first.place(3), nullptr);
    EXPECT_TRUE(keyframe_first.is_waiting(3));
    keyframe_first.set_pose(3, camera_at({1, 0, 0}));
    for (KeyframeStore* store : {&pose_first, &keyframe_first}) {
        const StoredKeyframe* keyframe = store->place(3);
        ASSERT_NE(keyframe, nullptr);
        EXPECT_TRUE(keyframe->world_from_camera->isApprox(camera_at({1, 0, 0})));
        EXPECT_EQ(store->waiting(), 0u);
        EXPECT_EQ(store->add(seen_by(3), losses), Arrival::kRefused) << "no map is made anew for it";
    }
    EXPECT_EQ(losses.keyframes_again, 2u);
}

TEST(KeyframeStore, OnTheHeapItTakesWhatIsSaid) {
    if (!test::heap_is_told()) GTEST_SKIP() << "this program's malloc does not tell what it gave out";
    std::vector<int> ids;
    for (int i = 0; i < 300; ++i) ids.push_back(i);
    const std::size_t before = test::heap_in_use();
    const auto store = std::make_unique<KeyframeStore>(placed(ids));
    const auto taken = static_cast<double>(test::heap_in_use() - before);
    EXPECT_NEAR(static_cast<double>(store->memory_bytes()), taken, 0.1 * taken);
}

TEST(KeyframeStore, CountsWhatItRefuses) {
    MapLosses losses;
    KeyframeStore store = placed({0, 1});
    Keyframe other = seen_by(1);
    ++other.utime;
    EXPECT_EQ(store.add(other, losses), Arrival::kRefused);
    EXPECT_EQ(losses.keyframes_of_others, 1u);
    EXPECT_EQ(store.add(seen_by(1 + 10001), losses), Arrival::kRefused);
    EXPECT_EQ(losses.keyframes_far_ahead, 1u);
    EXPECT_EQ(store.add(seen_by(1 + 10000), losses), Arrival::kNew);
    store.retire_oldest();
    EXPECT_EQ(store.add(seen_by(0), losses), Arrival::kRefused);
    EXPECT_EQ(losses.keyframes_too_late, 1u);
    EXPECT_FALSE(store.poses().contains(0));

    Keyframe hostile = seen_by(2);
    hostile.regions[0].plane.d = std::numeric_limits<double>::quiet_NaN();
    store.add(hostile, losses);
    EXPECT_EQ(losses.regions_refused, 1u);
    Keyframe crowded = seen_by(3);
    crowded.regions.assign(300, crowded.regions[0]);
    store.add(crowded, losses);
    EXPECT_EQ(losses.regions_too_many, 44u);
    EXPECT_EQ(store.keyframes().at(3).regions.size(), 256u);
}

TEST(KeyframeStore, TellsHowFarKeyframesMovedAndLeavesThemUntilTheyArePlaced) {
    MapLosses losses;
    KeyframeStore store = placed({0, 1, 2});
    KeyframeStore::Motion motion = store.update(poses({0, 1, 2}), kLimits, losses);
    EXPECT_FALSE(motion.any || motion.of_note);
    motion = store.update(poses({0, 1, 2}, 0.001), kLimits, losses);
    EXPECT_TRUE(motion.any);
    EXPECT_FALSE(motion.of_note);
    motion = store.update(poses({0, 1, 2}, 0.5), kLimits, losses);
    EXPECT_TRUE(motion.of_note);
    EXPECT_TRUE(store.keyframes().at(0).world_from_camera->isApprox(camera_at({0, 0, 0})));
    store.place_all();
    EXPECT_TRUE(store.keyframes().at(0).world_from_camera->isApprox(camera_at({0.5, 0, 0})));
    EXPECT_FALSE(store.update(poses({0, 1, 2}, 0.5), kLimits, losses).any);
}

TEST(KeyframeStore, IgnoresPosesThatAreNoneOrTooFar) {
    MapLosses losses;
    KeyframeStore store(200);
    store.add(seen_by(0), losses);
    for (const double x : {std::numeric_limits<double>::quiet_NaN(), 1e9}) {
        Pose bad = Pose::Identity();
        bad.translation().x() = x;
        store.set_pose(0, bad);
        store.update({{0, 0, bad}}, kLimits, losses);
    }
    EXPECT_EQ(losses.poses_refused, 2u);
    EXPECT_EQ(store.place(0), nullptr);
}

TEST(KeyframeStore, TheOldestThatWaitGo) {
    MapLosses losses;
    KeyframeStore store = placed({0, 1});
    for (int id = 2; id < 10; ++id) store.add(seen_by(id), losses);
    EXPECT_EQ(store.drop_waiting(8), 0u);
    EXPECT_EQ(store.drop_waiting(3), 5u);
    EXPECT_EQ(store.waiting(), 3u);
    std::vector<int> left;
    for (const auto& [id, keyframe] : store.keyframes()) left.push_back(id);
    EXPECT_THAT(left, ElementsAre(0, 1, 7, 8, 9)) << "those in the map stay";
}

TEST(KeyframeStore, ReplacedKeyframesLeave) {
    MapLosses losses;
    KeyframeStore store = placed({0, 1, 2, 3});
    EXPECT_TRUE(store.take_replaced(poses({0, 1, 2, 3})).empty());
    EXPECT_EQ(store.take_replaced(poses({0, 3})).size(), 2u);
    EXPECT_EQ(store.keyframes().size(), 2u);
    EXPECT_FALSE(store.poses().contains(1));
    store.update(poses({0, 3}), kLimits, losses);
    EXPECT_TRUE(store.take_replaced(poses({7})).empty()) << "another graph's trajectory";
}

/// There was nobody to hand over to, and the process died.
TEST(KeyframeStore, TheLastOnesInTheMapStayAlthoughTheyAreReplaced) {
    MapLosses losses;
    KeyframeStore store(200);
    store.add(seen_by(0), losses);
    store.update(poses({0, 1}), kLimits, losses);  // keyframe 1 was lost on its way
    store.place_all();
    EXPECT_TRUE(store.take_replaced(poses({1})).empty());
    EXPECT_EQ(store.keyframes().size(), 1u);
    EXPECT_TRUE(store.poses().contains(0));
}

TEST(KeyframeStore, TheNearestComeFirst) {
    KeyframeStore store = placed({0, 1, 2, 3, 4});
    const auto nearest = store.nearest(camera_at({0.32, 0, 0}), 3);
    ASSERT_EQ(nearest.size(), 3u);
    EXPECT_EQ(nearest[0], &store.keyframes().at(3));
    EXPECT_EQ(nearest[1], &store.keyframes().at(4));
    EXPECT_EQ(nearest[2], &store.keyframes().at(2));
    EXPECT_EQ(store.nearest(Pose::Identity(), 100).size(), 5u);
    EXPECT_TRUE(KeyframeStore(200).nearest(Pose::Identity(), 3).empty());
}

TEST(KeyframeStore, SightingsAreOfPlanesOnly) {
    KeyframeStore store = placed({0, 2});
    EXPECT_TRUE(store.sightings().empty());
    for (auto& [id, keyframe] : store.keyframes()) keyframe.regions[0].plane = 5;
    EXPECT_THAT(store.sightings().at(5), ElementsAre(0, 2));
}

}  // namespace
}  // namespace planemap::map
