// SPDX-License-Identifier: BSD-3-Clause
// What comes and what goes: a place that changes, as the map learns it from keyframes and looks.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/look.hpp"
#include "core/scene.hpp"
#include "map/map.hpp"

namespace planemap::map {
namespace {

using scene::camera_at;
using scene::facing;
using scene::keyframe;
using scene::Rectangle;

constexpr int kLooks = 5;  // that tell what changed, whatever went before

const Rectangle kWall{facing({0, 0, 3.5}, {0, 0, -1}, {1, 0, 0}), 2, 1.5, {}};
const Pose kCamera = camera_at({0, 0, 0});

Rectangle plate_at(double x, double half = 0.4) {
    return {facing({x, 0, 2.5}, {0, 0, -1}, {1, 0, 0}), half, half, {}};
}
const Rectangle kPlate = plate_at(0);

/// From near a keyframe, the camera where that was.
Look look_at(const Keyframe& from, int number, int looks, const std::vector<Rectangle>& seen) {
    Look look;
    look.keyframe_id = from.id;
    look.keyframe_utime = from.utime;
    look.utime = from.utime + 10000000 * number + 100000 * looks;
    look.number = number;
    look.looks = looks;
    if (look.is_news())
        for (const Rectangle& r : seen) look.regions.push_back(scene::region_of(r, kCamera, 0.02));
    return look;
}

/// A mapper before which a camera stands still.
struct Stand {
    PlaneMapper mapper;
    Keyframe first;

    explicit Stand(const std::vector<Rectangle>& seen, int looks = 1, const MapOptions& options = {})
        : mapper(options), first(keyframe(0, seen, kCamera)) {
        mapper.add(first, kCamera);
        for (int i = 2; i <= looks; ++i) mapper.add(look_at(first, 0, i, seen));
    }
    /// Looks that a state takes until the map has so many planes, and a rebuild says the same; 100: never.
    int looks_until(std::size_t planes, int number, const std::vector<Rectangle>& seen) {
        for (int i = 1; i <= kLooks; ++i) {
            mapper.add(look_at(first, number, i, seen));
            if (mapper.map().planes.size() != planes) continue;
            mapper.settle();
            EXPECT_EQ(mapper.map().planes.size(), planes) << "after a rebuild";
            return i;
        }
        return 100;
    }
};

TEST(Changes, AThingThatIsTakenAwayBeforeAStillCameraGoes) {
    for (const int before : {1, 2, 3, 5}) {
        Stand stand({kPlate, kWall}, before);
        ASSERT_EQ(stand.mapper.map().planes.size(), 2u);
        EXPECT_EQ(stand.looks_until(1, 1, {kWall}), before) << "seen so often, looked through as often";
        EXPECT_NEAR(static_cast<double>(stand.mapper.map().planes[0].center.z()), 3.5, 0.01);
        EXPECT_NEAR(static_cast<double>(stand.mapper.map().planes[0].area), 12, 0.3) << "the wall is whole";
    }
    Stand stand({kPlate, kWall}, 50);
    EXPECT_EQ(stand.looks_until(1, 1, {kWall}), kLooks) << "whatever went before";
}

TEST(Changes, AThingThatComesIntoFreeSpaceIsThereAfterFiveLooks) {
    for (const int before : {1, 3, 5, 50}) {
        Stand stand({kWall}, before);
        EXPECT_EQ(stand.looks_until(2, 1, {kPlate, kWall}), std::min(before + 1, kLooks));
    }
}

TEST(Changes, AThingWhereNobodyLookedIsThereAtItsFirstLook) {
    const Rectangle beside{facing({3, 0, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.4, 0.4, {}};
    Stand stand({kWall}, kLooks);
    EXPECT_EQ(stand.looks_until(2, 1, {beside, kWall}), 1);
}

TEST(Changes, AThingThatIsMovedIsAtItsNewPlaceOnly) {
    Stand stand({kPlate, kWall}, kLooks);
    const Rectangle moved{facing({0.65, 0, 2}, {0, 0, -1}, {1, 0, 0}), 0.3, 0.4, {}};
    for (int i = 1; i <= kLooks; ++i) stand.mapper.add(look_at(stand.first, 1, i, {moved, kWall}));
    for (const bool settled : {false, true}) {
        if (settled) stand.mapper.settle();
        std::vector<float> depths;
        for (const MapPlane& plane : stand.mapper.map().planes) depths.push_back(plane.center.z());
        std::sort(depths.begin(), depths.end());
        ASSERT_EQ(depths.size(), 2u);
        EXPECT_NEAR(depths[0], 2, 0.01);
        EXPECT_NEAR(depths[1], 3.5, 0.01);
    }
}

TEST(Changes, WhoWalksThroughLeavesNothing) {
    Stand stand({kWall}, kLooks);
    // 1.5 m/s, and 0.6 m wide.
    for (int i = 1; i <= 12; ++i) {
        stand.mapper.add(look_at(stand.first, i, 1, {plate_at(-1 + 0.15 * i, 0.3), kWall}));
        EXPECT_EQ(stand.mapper.map().planes.size(), 1u) << "no place was seen for five looks";
    }
    stand.mapper.add(look_at(stand.first, 13, 1, {kWall}));
    EXPECT_EQ(stand.mapper.map().planes.size(), 1u);
    stand.mapper.settle();
    EXPECT_EQ(stand.mapper.map().planes.size(), 1u);
}

TEST(Changes, WhatAKeyframeSawPastGoesWithoutLooksToo) {
    PlaneMapper mapper;
    for (int i = 0; i < 12; ++i) {
        const Pose pose = camera_at({0.02 * i, 0, 0});
        mapper.add(keyframe(i, i < 6 ? std::vector{kPlate, kWall} : std::vector{kWall}, pose), pose);
        EXPECT_EQ(mapper.map().planes.size(), i < 6 + kLooks - 1 ? 2u : 1u) << i;
    }
    mapper.settle();
    EXPECT_EQ(mapper.map().planes.size(), 1u);
}

TEST(Changes, OfALoadedMap) {
    Stand before({kPlate, kWall}, kLooks);
    PlaneMapper mapper;
    mapper.start_from(before.mapper.map());
    ASSERT_EQ(mapper.map().planes.size(), 2u);
    const Keyframe now = keyframe(0, {kWall}, kCamera);
    mapper.add(now, kCamera);
    for (int i = 2; i <= kLooks; ++i) {
        EXPECT_EQ(mapper.map().planes.size(), 2u);
        mapper.add(look_at(now, 0, i, {}));
    }
    EXPECT_EQ(mapper.map().planes.size(), 1u) << "looked through five times";
    mapper.settle();
    EXPECT_EQ(mapper.map().planes.size(), 1u);
    for (int i = 1; i <= kLooks; ++i) mapper.add(look_at(now, 1, i, {kPlate, kWall}));
    EXPECT_EQ(mapper.map().planes.size(), 2u) << "and there again";
    mapper.settle();
    EXPECT_EQ(mapper.map().planes.size(), 2u);
}

TEST(Changes, OfFoldedKeyframes) {
    MapOptions options;
    options.fold_after = 2;
    for (const bool goes : {true, false}) {
        PlaneMapper mapper(options);
        const std::vector<Rectangle> with{kPlate, kWall}, without{kWall};
        for (int i = 0; i < 20; ++i) {
            const Pose pose = camera_at({0.02 * i, 0, 0});
            mapper.add(keyframe(i, (i < 10) == goes ? with : without, pose), pose);
        }
        EXPECT_EQ(mapper.work().folded, 18u);
        EXPECT_EQ(mapper.map().planes.size(), goes ? 1u : 2u);
        mapper.settle();
        EXPECT_EQ(mapper.map().planes.size(), goes ? 1u : 2u);
    }
    // Looks go with their keyframe.
    Stand stand({kPlate, kWall}, kLooks, options);
    EXPECT_EQ(stand.looks_until(1, 1, {kWall}), kLooks);
    const Rectangle elsewhere{facing({0, 0, -3.5}, {0, 0, 1}, {1, 0, 0}), 2, 1.5, {}};
    const Pose turned = camera_at({0, 0, -1}) * Eigen::AngleAxisd(3.14159265, Eigen::Vector3d::UnitY());
    for (int i = 1; i < 5; ++i) stand.mapper.add(keyframe(i, {elsewhere}, turned), turned);
    EXPECT_EQ(stand.mapper.work().folded, 3u);
    stand.mapper.settle();
    EXPECT_EQ(stand.mapper.map().planes.size(), 2u) << "two walls";
}

TEST(Changes, StayWhatTheyAreWhenTheirKeyframeIsReplaced) {
    for (const int gone : {0, 1}) {
        PlaneMapper mapper;
        const Keyframe first = keyframe(0, {kPlate, kWall}, kCamera), second = keyframe(1, {kWall}, kCamera);
        KeyframeTrajectory both;
        both.keyframes = {{0, 0, kCamera}, {1, 0, kCamera}};
        for (const Keyframe& k : {first, second}) mapper.add(k);
        mapper.update(both);
        for (int i = 2; i <= 3; ++i) mapper.add(look_at(second, 0, i, {}));
        EXPECT_EQ(mapper.map().planes.size(), 1u);
        KeyframeTrajectory one;
        one.keyframes = {both.keyframes[static_cast<std::size_t>(1 - gone)]};
        mapper.update(one);
        EXPECT_EQ(mapper.keyframes(), 1u);
        mapper.settle();
        EXPECT_EQ(mapper.map().planes.size(), 1u) << "keyframe " << gone << " went";
        // Odometry still tracks against it.
        const Keyframe& lost = gone == 0 ? first : second;
        for (int i = 1; i <= kLooks; ++i) mapper.add(look_at(lost, 1, i, {kPlate, kWall}));
        EXPECT_EQ(mapper.losses().looks_refused, 0u);
        EXPECT_EQ(mapper.map().planes.size(), 2u);
        mapper.settle();
        EXPECT_EQ(mapper.map().planes.size(), 2u);
    }
}

TEST(Changes, MayComeBeforeThePose) {
    PlaneMapper mapper;
    const Keyframe first = keyframe(0, {kPlate, kWall}, kCamera);
    mapper.add(first);
    for (int i = 1; i <= 2; ++i) mapper.add(look_at(first, 1, i, {kWall}));
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{0, 0, kCamera}};
    mapper.update(trajectory);
    EXPECT_EQ(mapper.map().planes.size(), 1u);
}

TEST(Changes, OfABusyPlaceAreBounded) {
    Stand stand({kWall});
    std::size_t bytes = 0;
    for (int i = 1; i <= 200; ++i) {
        stand.mapper.add(look_at(stand.first, i, 1, {plate_at(-0.9 + 0.09 * (i % 20)), kWall}));
        if (i == 20) bytes = stand.mapper.working_bytes();
    }
    EXPECT_LT(stand.mapper.working_bytes(), 2 * bytes);
    stand.mapper.settle();
    EXPECT_LE(stand.mapper.map().planes.size(), 2u);
}

TEST(Changes, LooksThatMakeNoSenseAreCountedAndIgnored) {
    Stand stand({kPlate, kWall});
    Keyframe unknown = stand.first;
    unknown.id = 7;
    EXPECT_FALSE(stand.mapper.add(look_at(unknown, 1, 1, {kWall})));
    unknown = stand.first;
    unknown.utime += 1;
    EXPECT_FALSE(stand.mapper.add(look_at(unknown, 1, 1, {kWall}))) << "of another odometry";
    EXPECT_FALSE(stand.mapper.add(look_at(stand.first, 3, 2, {}))) << "of a state that never began";
    Look nowhere = look_at(stand.first, 1, 1, {kWall});
    nowhere.keyframe_from_camera.translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(stand.mapper.add(nowhere));
    EXPECT_EQ(stand.mapper.losses().looks_refused, 4u);
    EXPECT_EQ(stand.mapper.map().planes.size(), 2u);
}

}  // namespace
}  // namespace planemap::map
