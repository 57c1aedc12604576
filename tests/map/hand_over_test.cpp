// SPDX-License-Identifier: BSD-3-Clause
#include "map/hand_over.hpp"

#include <gtest/gtest.h>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::camera_at;
using scene::facing;
using scene::Rectangle;

/// A keyframe in the map that sees these; they are of planes 0, 1, 2 and so on.
StoredKeyframe placed(const Pose& world_from_camera, const std::vector<Rectangle>& seen) {
    std::vector<PlanarRegion> regions;
    for (const Rectangle& r : seen) regions.push_back(scene::region_of(r, world_from_camera, 0.02, 0.003));
    StoredKeyframe keyframe = stored(0, regions);
    keyframe.world_from_camera = world_from_camera;
    for (std::size_t i = 0; i < seen.size(); ++i) keyframe.regions[i].plane = static_cast<int>(i);
    return keyframe;
}

/// All points of a plane, in the world.
Moments points_of(int plane, const std::vector<const StoredKeyframe*>& keyframes) {
    Moments sum;
    for (const StoredKeyframe* keyframe : keyframes) {
        for (const StoredRegion& region : keyframe->regions)
            if (region.plane == plane) sum += PlacedRegion(*keyframe->world_from_camera, region).moments;
    }
    return sum;
}

const Rectangle kWall{facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.8, {}};
const Pose kHere = camera_at({0, 0, 0}), kAside = camera_at({0.2, 0.1, 0}, 0.1),
           kFar = camera_at({1, 0, 0}, 0.3);

const auto kCentimetre = [](const StoredRegion&) { return 0.01; };

TEST(HandOver, PointsOfWhatOthersSawJoinTheNearest) {
    const Rectangle farther{facing({0, 0, 3.006}, {0, 0, -1}, {1, 0, 0}), 1, 0.8, {}};
    const StoredKeyframe gone = placed(kHere, {kWall});
    StoredKeyframe near = placed(kAside, {kWall}), far = placed(kFar, {farther});
    const Moments all = points_of(0, {&gone, &near, &far}), of_far = points_of(0, {&far});
    hand_over(gone, {&near, &far}, kCentimetre);
    ASSERT_EQ(near.regions.size(), 1u);
    EXPECT_EQ(near.regions[0].keyframes, 2);
    EXPECT_EQ(far.regions[0].keyframes, 1);
    EXPECT_EQ(points_of(0, {&far}).count, of_far.count);
    const Moments now = points_of(0, {&near, &far});
    EXPECT_EQ(now.count, all.count);
    EXPECT_LT((now.mean() - all.mean()).norm(), 1e-6);
    EXPECT_LT((now.covariance() - all.covariance()).norm(), 1e-6);
    // The region lies on its points.
    const PlacedRegion region(kAside, near.regions[0]);
    EXPECT_LT(
        angle_between(region.plane.normal, fit_plane(region.moments, kAside.translation()).plane.normal),
        1e-5);
    EXPECT_NEAR(region.plane.signed_distance(region.moments.mean()), 0, 1e-5);
}

TEST(HandOver, SeveralMayCoverWhatOneDoesNot) {
    const Rectangle left{facing({-0.55, 0, 3}, {0, 0, -1}, {1, 0, 0}), 0.55, 0.8, {}};
    const Rectangle right{facing({0.55, 0, 3}, {0, 0, -1}, {1, 0, 0}), 0.55, 0.8, {}};
    const StoredKeyframe gone = placed(kHere, {kWall});
    StoredKeyframe near = placed(kAside, {left}), far = placed(kFar, {right});
    hand_over(gone, {&near, &far}, kCentimetre);
    EXPECT_EQ(near.regions.size(), 1u);
    EXPECT_EQ(near.regions[0].keyframes + far.regions[0].keyframes, 3);
}

TEST(HandOver, WhatNobodyElseSawMovesAsItIs) {
    const Rectangle half{facing({-0.5, 0, 3}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.8, {}};
    const Rectangle holed{
        facing({0, 1, 2}, {0, -1, 0}, {1, 0, 0}), 0.5, 0.5, {scene::rectangle_ring(-0.2, -0.2, 0.1, 0.2)}};
    const StoredKeyframe gone = placed(kHere, {kWall, holed});
    StoredKeyframe near = placed(kAside, {half});
    const std::uint32_t before = near.regions[0].last;
    const float count = near.regions[0].count;
    hand_over(gone, {&near}, kCentimetre);
    ASSERT_EQ(near.regions.size(), 3u) << "half of the wall is not the wall";
    EXPECT_EQ(near.regions[0].count, count);
    EXPECT_EQ(near.regions[0].last, before);
    for (const std::size_t i : {0u, 1u}) {
        const PlacedRegion was(kHere, gone.regions[i]), is(kAside, near.regions[i + 1]);
        EXPECT_EQ(near.regions[i + 1].plane, gone.regions[i].plane);
        EXPECT_LT((was.box.frame_from_box.matrix() - is.box.frame_from_box.matrix()).norm(), 1e-5);
        EXPECT_EQ(was.moments.count, is.moments.count);
        EXPECT_LT((was.moments.covariance() - is.moments.covariance()).norm(), 1e-5);
        FlatPolygon a, b;
        outline_in(Pose::Identity(), gone.regions[i], gone, a);
        outline_in(Pose::Identity(), near.regions[i + 1], near, b);
        EXPECT_EQ(a.vertices, b.vertices);
        EXPECT_EQ(a.ring_ends, b.ring_ends);
    }
}

TEST(HandOver, WhatIsBeforeACupboardIsNoViewOfIt) {
    // Both are one plane of the map, by the merging rules.
    const Rectangle binders{facing({0, 0, 2.96}, {0, 0, -1}, {1, 0, 0}), 0.6, 0.3, {}};
    const StoredKeyframe gone = placed(kHere, {binders});
    StoredKeyframe near = placed(kAside, {kWall});
    StoredKeyframe far = placed(kFar, {binders});
    hand_over(gone, {&near, &far}, kCentimetre);
    EXPECT_EQ(near.regions[0].keyframes, 1);
    EXPECT_EQ(far.regions[0].keyframes, 2) << "the other view of the binders takes them";
    hand_over(gone, {&near}, kCentimetre);
    EXPECT_EQ(near.regions[0].keyframes, 1);
    EXPECT_EQ(near.regions.size(), 2u) << "without one they stay apart";
}

TEST(HandOver, WhatIsOnNoPlaneEnds) {
    StoredKeyframe gone = placed(kHere, {kWall});
    gone.regions[0].plane = -1;
    StoredKeyframe near = placed(kAside, {});
    hand_over(gone, {&near}, kCentimetre);
    EXPECT_TRUE(near.regions.empty());
}

}  // namespace
}  // namespace planemap::map
