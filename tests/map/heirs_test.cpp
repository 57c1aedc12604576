// SPDX-License-Identifier: BSD-3-Clause
#include "map/heirs.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::camera_at;

StoredKeyframe keyframe(int id, double x) {
    StoredKeyframe keyframe;
    keyframe.id = id;
    keyframe.utime = 100 * id;
    keyframe.world_from_camera = camera_at({x, 0, 0});
    return keyframe;
}

TEST(Heirs, APoseAboutTheOneThatWentIsOneAboutItsHeir) {
    Heirs heirs;
    heirs.add(keyframe(1, 0), keyframe(2, 0.5));
    heirs.add(keyframe(2, 0.5), keyframe(7, 2));
    const Pose world_from_look = camera_at({0.3, 0, 0});
    Pose keyframe_from_look = keyframe(1, 0).world_from_camera->inverse() * world_from_look;
    Heirs::Place place{1, 100};
    ASSERT_TRUE(heirs.follow(place, keyframe_from_look));
    EXPECT_EQ(place.id, 2);
    ASSERT_TRUE(heirs.follow(place, keyframe_from_look));
    EXPECT_EQ(place.id, 7);
    EXPECT_EQ(place.utime, 700);
    EXPECT_TRUE((*keyframe(7, 2).world_from_camera * keyframe_from_look).isApprox(world_from_look, 1e-9));
    EXPECT_FALSE(heirs.follow(place, keyframe_from_look)) << "it is there itself";
}

TEST(Heirs, AKeyframeOfAnotherSessionWithTheSameIdHasNone) {
    Heirs heirs;
    heirs.add(keyframe(1, 0), keyframe(2, 0.5));
    Pose pose = Pose::Identity();
    Heirs::Place place{1, 12345};
    EXPECT_FALSE(heirs.follow(place, pose));
    EXPECT_EQ(place.id, 1);
    EXPECT_TRUE(pose.isApprox(Pose::Identity(), 0));
}

TEST(Heirs, TheLastOnesAreKnown) {
    Heirs heirs, others;
    for (int id = 1; id <= 100; ++id) heirs.add(keyframe(id, 0), keyframe(1000, 1));
    others.add(keyframe(500, 0), keyframe(1000, 1));
    heirs.absorb(std::move(others));
    Pose pose = Pose::Identity();
    Heirs::Place first{1, 100}, last{100, 10000}, absorbed{500, 50000};
    EXPECT_FALSE(heirs.follow(first, pose));
    EXPECT_TRUE(heirs.follow(last, pose));
    EXPECT_TRUE(heirs.follow(absorbed, pose));
}

}  // namespace
}  // namespace planemap::map
