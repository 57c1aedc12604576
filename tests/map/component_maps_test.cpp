// SPDX-License-Identifier: BSD-3-Clause
#include "map/component_maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::keyframe;
using scene::Rectangle;

const Rectangle kWall{facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 1, 1, {}};
const Rectangle kFloor{facing({0, 1, 2}, {0, -1, 0}, {1, 0, 0}), 1, 0.8, {}};

Pose at(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

/// Keyframes 0 and 1 see the wall, 5 and 6 wall and floor. They are all taken from one place.
class Components : public testing::Test {
  protected:
    void come() {
        for (const int id : {0, 1}) maps_.add(keyframe(id, {kWall}, Pose::Identity()));
        for (const int id : {5, 6}) maps_.add(keyframe(id, {kWall, kFloor}, Pose::Identity()));
    }
    /// The second component's keyframes at `second`.
    void place(int component, const Pose& second) {
        KeyframeTrajectory trajectory;
        trajectory.revision = ++revision_;
        for (const int id : {0, 1}) trajectory.keyframes.push_back({id, 1000, Pose::Identity(), 0});
        for (const int id : {5, 6}) trajectory.keyframes.push_back({id, 1000, second, component});
        maps_.update(trajectory);
    }
    static std::set<int> ids(const PlaneMapper& map) {
        std::set<int> ids;
        for (const MapPlane& plane : map.map().planes) ids.insert(plane.id);
        return ids;
    }

    ComponentMaps maps_{MapOptions{}};
    int revision_ = 0;
};

TEST_F(Components, WithoutATrajectoryAllWait) {
    come();
    EXPECT_EQ(maps_.waiting(), 4u);
    EXPECT_EQ(maps_.keyframes(), 4u);
    ASSERT_EQ(maps_.all().size(), 1u);
    EXPECT_TRUE(maps_.largest().map().planes.empty());
    maps_.add(keyframe(0, {kWall}, Pose::Identity()));
    EXPECT_EQ(maps_.losses().keyframes_again, 1u);
}

TEST_F(Components, WhatDoesNotHangTogetherMakesTwoMapsWhoseIdsDiffer) {
    come();
    place(5, at(0.3));
    maps_.settle();
    EXPECT_EQ(maps_.waiting(), 0u);
    ASSERT_EQ(maps_.all().size(), 2u);
    const PlaneMapper &first = *maps_.all()[0], &second = *maps_.all()[1];
    EXPECT_EQ(first.map().component, 0);
    EXPECT_EQ(second.map().component, 5);
    EXPECT_EQ(ids(first).size(), 1u);
    EXPECT_EQ(ids(second).size(), 2u);
    std::set<int> all = ids(first);
    all.merge(ids(second));
    EXPECT_EQ(all.size(), 3u);
    EXPECT_EQ(maps_.surfaces().keyframes.size(), 4u);
}

TEST_F(Components, JoinedTheyAreOneMapAndPlanesKeepTheirIds) {
    come();
    place(5, at(0.3));
    maps_.settle();
    const std::set<int> wall = ids(*maps_.all()[0]), others = ids(*maps_.all()[1]);
    place(0, at(0));
    maps_.settle();
    ASSERT_EQ(maps_.all().size(), 1u);
    EXPECT_EQ(maps_.keyframes(), 4u);
    const std::set<int> now = ids(maps_.largest());
    EXPECT_EQ(now.size(), 2u);
    for (const int id : now) EXPECT_TRUE(wall.contains(id) || others.contains(id)) << id;
    for (const MapPlane& plane : maps_.largest().map().planes) EXPECT_NEAR(plane.area, 4, 0.9);
    for (const KeyframeSurfaces& keyframe : maps_.surfaces().keyframes)
        for (const int plane : keyframe.planes) EXPECT_TRUE(now.contains(plane));
}

TEST_F(Components, TheLargestIsTheOneWithTheMostKeyframes) {
    come();
    maps_.add(keyframe(7, {kWall, kFloor}, Pose::Identity()));
    KeyframeTrajectory trajectory;
    for (const int id : {0, 1}) trajectory.keyframes.push_back({id, 1000, Pose::Identity(), 0});
    for (const int id : {5, 6, 7}) trajectory.keyframes.push_back({id, 1000, Pose::Identity(), 5});
    maps_.update(trajectory);
    EXPECT_EQ(maps_.largest().map().component, 5);
}

TEST_F(Components, WhatATrajectoryNamesAndNeverCameMakesNoMap) {
    KeyframeTrajectory trajectory;
    for (int id = 0; id < 1000; ++id) trajectory.keyframes.push_back({id, 1000, Pose::Identity(), id});
    maps_.update(trajectory);
    EXPECT_EQ(maps_.all().size(), 1u);
    maps_.add(keyframe(7, {kWall}, Pose::Identity()));
    ASSERT_EQ(maps_.all().size(), 2u);
    EXPECT_EQ(maps_.all()[1]->map().component, 7);
    EXPECT_EQ(maps_.waiting(), 0u);
    maps_.settle();
    EXPECT_EQ(ids(*maps_.all()[1]).size(), 1u);
}

TEST_F(Components, LooksGoWithTheirKeyframe) {
    come();
    Look look;
    look.keyframe_id = 5;
    look.keyframe_utime = keyframe(5, {}, Pose::Identity()).utime;
    look.looks = 2;
    EXPECT_FALSE(maps_.add(look)) << "it waits";
    place(5, at(0.3));
    EXPECT_EQ(maps_.losses().looks_refused, 0u);
    look.keyframe_id = 99;
    EXPECT_FALSE(maps_.add(look));
    EXPECT_EQ(maps_.losses().looks_refused, 1u);
}

}  // namespace
}  // namespace planemap::map
