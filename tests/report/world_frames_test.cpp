// SPDX-License-Identifier: BSD-3-Clause
#include "report/world_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exports/corner.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

/// A walk of n poses from `start` on, moved and turned in the world.
Trajectory walk(int n, std::int64_t start, const Pose& moved = Pose::Identity()) {
    Trajectory trajectory;
    for (int i = 0; i < n; ++i) {
        Pose pose = Pose::Identity();
        pose.translation() = Eigen::Vector3d(0.1 * i, 0, 0);
        trajectory.push_back({start + i * 33333, moved * pose});
    }
    return trajectory;
}

PlaneMap room() {
    PlaneMap map = scene::corner();
    map.planes.push_back(scene::plane_of(20, {scene::facing({0, 1, 1}, {0, -1, 0}, {1, 0, 0}), 1, 1, {}}));
    return map;
}

WorldFrames of(const PlaneMap& map_a, const Trajectory& a, const PlaneMap& map_b, const Trajectory& b) {
    return compare_world_frames(map_a, a, map_b, b, evaluation::match_planes(map_a, map_b));
}

TEST(WorldFrames, PosesOfTheSameMomentsTell) {
    const Trajectory a = walk(50, 0);
    Pose near = Pose::Identity(), far = Pose::Identity(), turned = Pose::Identity();
    near.translation().x() = 0.05;
    far.translation().x() = 0.5;
    turned.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix();
    EXPECT_TRUE(of({}, a, {}, walk(50, 0, near)).are_one);
    EXPECT_FALSE(of(room(), a, room(), walk(50, 0, far)).are_one) << "whatever the planes say";
    const WorldFrames frames = of(room(), a, room(), walk(50, 0, turned));
    EXPECT_FALSE(frames.are_one);
    EXPECT_THAT(frames.why, HasSubstr("50 poses of the same moments are 0.000 m and 11.46 deg apart"));
}

TEST(WorldFrames, WithoutThemThePlanesTell) {
    const WorldFrames same = of(room(), walk(50, 0), room(), walk(50, 1'000'000'000));
    EXPECT_TRUE(same.are_one);
    EXPECT_THAT(same.why, HasSubstr("100 % of the smaller map's area"));
    EXPECT_TRUE(of(room(), {}, room(), {}).are_one);
    PlaneMap parallel = room(), moved = room();
    parallel.planes.resize(1);
    const WorldFrames slides = of(parallel, {}, parallel, {});
    EXPECT_FALSE(slides.are_one) << "a floor alone says nothing of x, y and heading";
    EXPECT_THAT(slides.why, HasSubstr("not in three directions"));
    for (MapPlane& plane : moved.planes) plane.center += Eigen::Vector3f(5, 5, 5);
    EXPECT_FALSE(of(room(), {}, moved, {}).are_one);
    EXPECT_FALSE(of({}, {}, {}, {}).are_one);
}

}  // namespace
}  // namespace planemap
