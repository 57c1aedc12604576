// SPDX-License-Identifier: BSD-3-Clause
#include "map/planes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>

#include "heap.hpp"
#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::points_of;
using samples::wall_at;
using scene::camera_at;
using scene::Rectangle;

/// Planes and the keyframes that they grow from.
struct Mapping {
    MapLosses losses;
    KeyframeStore store{200};
    Planes planes{MapOptions{}};

    void see(int id, const std::vector<Rectangle>& seen, const Pose& world_from_camera,
             const Pose& truly = Pose::Identity()) {
        store.add(scene::keyframe(id, seen, truly), losses);
        store.set_pose(id, world_from_camera);
        store.place(id);
        planes.integrate(id, store, losses);
    }
    double points_seen() const {
        double points = 0;
        for (const auto& [id, keyframe] : store.keyframes())
            for (const StoredRegion& region : keyframe.regions) points += static_cast<double>(region.count);
        return points;
    }
    /// What must be true whenever a call has ended.
    void expect_consistent() const {
        std::set<int> ids;
        for (const PlaneEstimate& plane : planes.estimates())
            EXPECT_TRUE(ids.insert(plane.id).second) << "an id twice";
        std::map<int, std::set<int>> seen_by;
        for (const auto& [id, keyframe] : store.keyframes()) {
            for (const StoredRegion& region : keyframe.regions) {
                EXPECT_TRUE(ids.contains(region.plane)) << "a region of a plane that is gone";
                seen_by[region.plane].insert(id);
            }
        }
        for (const PlaneEstimate& plane : planes.estimates())
            EXPECT_EQ(plane.keyframes, static_cast<int>(seen_by[plane.id].size()));
        EXPECT_NEAR(points_of(planes.estimates()), points_seen(), 1e-3) << "points are lost";
    }
};

TEST(Planes, OnTheHeapTheyTakeWhatIsSaid) {
    if (!test::heap_is_told()) GTEST_SKIP() << "this program's malloc does not tell what it gave out";
    Mapping mapping;
    for (int i = 0; i < 12; ++i)
        mapping.see(i, {wall_at(4.0 * i, 0, 3, 1.5), wall_at(4.0 * i, 0, 4.5, 1)}, Pose::Identity());
    ASSERT_GE(mapping.planes.estimates().size(), 10u);
    const std::size_t before = test::heap_in_use();
    const auto alone = std::make_unique<Planes>(mapping.planes);
    const auto taken = static_cast<double>(test::heap_in_use() - before);
    EXPECT_NEAR(static_cast<double>(alone->memory_bytes()), taken, 0.1 * taken);
}

TEST(Planes, RegionsKnowTheirPlanesThroughMergersAndRebuilds) {
    Mapping mapping;
    const Pose here = Pose::Identity();
    mapping.see(0, {wall_at(-1.6, 0, 3), wall_at(0, 0, 4, 2)}, here);
    mapping.see(1, {wall_at(1.6, 0, 3)}, here);
    mapping.expect_consistent();
    ASSERT_EQ(mapping.planes.estimates().size(), 3u);
    mapping.see(2, {wall_at(0, 0, 3, 1.2)}, here);  // joins both parts
    ASSERT_EQ(mapping.planes.estimates().size(), 2u);
    mapping.expect_consistent();
    std::set<int> before, after;
    for (const PlaneEstimate& plane : mapping.planes.estimates()) before.insert(plane.id);
    mapping.planes.rebuild(mapping.store);
    mapping.expect_consistent();
    for (const PlaneEstimate& plane : mapping.planes.estimates()) after.insert(plane.id);
    EXPECT_EQ(before, after);
}

TEST(Planes, ARegionTooFarOutIsOfNoPlaneAndCounted) {
    Mapping mapping;
    const Pose afar = camera_at({kMaxCoordinate_m - 1, 0, 0});
    mapping.see(0, {wall_at(0.5, 0, 3), wall_at(10, 0, 3)}, afar);
    EXPECT_EQ(mapping.losses.regions_too_far, 1u);
    ASSERT_EQ(mapping.planes.estimates().size(), 1u);
    mapping.planes.rebuild(mapping.store);
    EXPECT_EQ(mapping.planes.estimates().size(), 1u);
    const auto& regions = mapping.store.keyframes().at(0).regions;
    EXPECT_EQ(std::count_if(regions.begin(), regions.end(), [](auto& r) { return r.plane < 0; }), 1);
}

TEST(Planes, WhatIsFoldedStaysThroughARebuild) {
    Mapping mapping;
    const Pose here = Pose::Identity();
    for (int i = 0; i < 3; ++i) mapping.see(i, {wall_at(0.3 * i, 0, 3)}, here);
    const double points = mapping.points_seen();
    const int id = mapping.planes.estimates()[0].id;
    for (int i = 0; i < 3; ++i) {
        mapping.planes.fold(i, mapping.store.keyframes().at(i));
        mapping.store.retire_oldest();
    }
    mapping.planes.rebuild(mapping.store);
    ASSERT_EQ(mapping.planes.estimates().size(), 1u);
    EXPECT_EQ(mapping.planes.estimates()[0].id, id);
    EXPECT_EQ(mapping.planes.estimates()[0].keyframes, 3);
    EXPECT_NEAR(points_of(mapping.planes.estimates()), points, 1e-3);
    mapping.planes.rebuild(mapping.store);
    EXPECT_NEAR(points_of(mapping.planes.estimates()), points, 1e-3) << "and through another one";
}

TEST(Planes, FoldedPlanesThatMergeBecomeOne) {
    Mapping mapping;
    const Pose here = Pose::Identity();
    mapping.see(0, {wall_at(-1.6, 0, 3)}, here);
    mapping.see(1, {wall_at(1.6, 0, 3)}, here);
    ASSERT_EQ(mapping.planes.estimates().size(), 2u);
    for (int i = 0; i < 2; ++i) {
        mapping.planes.fold(i, mapping.store.keyframes().at(i));
        mapping.store.retire_oldest();
    }
    mapping.see(2, {wall_at(0, 0, 3, 1.2)}, here);
    ASSERT_EQ(mapping.planes.estimates().size(), 1u);
    EXPECT_EQ(mapping.planes.estimates()[0].keyframes, 3);
    const double points = points_of(mapping.planes.estimates());
    mapping.planes.rebuild(mapping.store);
    ASSERT_EQ(mapping.planes.estimates().size(), 1u);
    EXPECT_EQ(mapping.planes.estimates()[0].id, 0) << "the older id stays";
    EXPECT_EQ(mapping.planes.estimates()[0].keyframes, 3);
    EXPECT_NEAR(points_of(mapping.planes.estimates()), points, 1e-3);
}

TEST(Planes, NewOnesDoNotTakeTheIdsOfAMapToStartFrom) {
    Mapping mapping;
    mapping.planes.start_from(samples::drawn_estimate_of(wall_at(0, 0, 3), 7));
    mapping.planes.rebuild(mapping.store);
    ASSERT_EQ(mapping.planes.estimates().size(), 1u);
    mapping.see(0, {wall_at(0, 0, 3), wall_at(0, 0, 5)}, Pose::Identity());
    ASSERT_EQ(mapping.planes.estimates().size(), 2u);
    EXPECT_EQ(mapping.planes.estimates()[0].id, 7);
    EXPECT_EQ(mapping.planes.estimates()[1].id, 8);
}

TEST(Planes, OfNothing) {
    Mapping mapping;
    mapping.planes.rebuild(mapping.store);
    mapping.see(0, {}, Pose::Identity());
    mapping.planes.fold(0, mapping.store.keyframes().at(0));
    mapping.planes.rebuild(mapping.store);
    EXPECT_TRUE(mapping.planes.estimates().empty());
    EXPECT_EQ(mapping.planes.memory_bytes(), 0u);
}

}  // namespace
}  // namespace planemap::map
