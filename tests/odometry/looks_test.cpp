// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/looks.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/scene.hpp"

namespace planemap::odometry {
namespace {

using scene::camera_at;
using scene::facing;
using scene::Rectangle;

constexpr std::int64_t kStep_us = 100000;

const Rectangle kWall{facing({0, 0, 3.5}, {0, 0, -1}, {1, 0, 0}), 2, 1.5, {}};

Rectangle plate_at(double x) {
    return {facing({x, 0, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.4, 0.4, {}};
}

/// A camera that takes a frame every 0.1 s, tracked against its first keyframe.
struct Camera {
    Looks looks;
    std::int64_t utime = 1000000;

    explicit Camera(const std::vector<Rectangle>& seen) {
        Keyframe keyframe = scene::keyframe(3, seen, Pose::Identity());
        keyframe.utime = utime;
        looks.begin(keyframe);
    }
    std::optional<Look> see(const std::vector<Rectangle>& seen, const Pose& at = Pose::Identity(),
                            std::int64_t step = kStep_us, TrackingStatus status = TrackingStatus::kTracked) {
        utime += step;
        OdometryEstimate estimate;
        estimate.utime = utime;
        estimate.status = status;
        estimate.keyframe_id = 3;
        estimate.keyframe_from_camera = at;
        std::vector<PlanarRegion> regions;
        for (const Rectangle& r : seen) regions.push_back(scene::region_of(r, at, 0.05));
        return looks.see(estimate, regions);
    }
};

TEST(Looks, OfAStillPlaceAreSaidUntilTheyCountNoMore) {
    Camera camera({kWall, plate_at(0)});
    for (int i = 2; i <= kLooksThatCount; ++i) {
        const std::optional<Look> look = camera.see({kWall, plate_at(0)});
        ASSERT_TRUE(look);
        EXPECT_EQ(look->keyframe_id, 3);
        EXPECT_EQ(look->keyframe_utime, 1000000);
        EXPECT_EQ(look->number, 0);
        EXPECT_EQ(look->looks, i);
        EXPECT_TRUE(look->regions.empty());
    }
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(camera.see({kWall, plate_at(0)}));
}

TEST(Looks, SayWhatComesAndWhatGoes) {
    for (const bool goes : {true, false}) {
        const std::vector<Rectangle> with{kWall, plate_at(0)}, without{kWall};
        Camera camera(goes ? with : without);
        for (int i = 0; i < 10; ++i) camera.see(goes ? with : without);
        for (int i = 1; i <= kLooksThatCount; ++i) {
            const std::optional<Look> look = camera.see(goes ? without : with);
            ASSERT_TRUE(look);
            EXPECT_EQ(look->number, 1);
            EXPECT_EQ(look->looks, i);
            EXPECT_EQ(look->regions.size(), i > 1 ? 0u : goes ? 1u : 2u);
        }
        EXPECT_FALSE(camera.see(goes ? without : with));
        const std::optional<Look> back = camera.see(goes ? with : without);
        ASSERT_TRUE(back);
        EXPECT_EQ(back->number, 2);
    }
}

TEST(Looks, AMovingCameraThatSeesTheSameSeesNoChange) {
    const std::vector<Rectangle> seen{kWall, plate_at(0.2)};
    Camera camera(seen);
    for (int i = 1; i < 20; ++i) {
        const std::optional<Look> look =
            camera.see(seen, camera_at({0.02 * i, 0.01 * i, 0.01 * i}, 0.01 * i));
        if (look) {
            EXPECT_EQ(look->number, 0) << "what the plate hides now is no change";
        }
    }
}

TEST(Looks, AreATenthOfASecondApartAndOnlyOfTrackedFramesWithRegions) {
    Camera camera({kWall, plate_at(0)});
    EXPECT_FALSE(camera.see({kWall}, Pose::Identity(), kStep_us / 3));
    EXPECT_TRUE(camera.see({kWall}, Pose::Identity(), kStep_us)) << "a third of a second since the last";
    EXPECT_FALSE(camera.see({}));
    EXPECT_FALSE(camera.see({kWall}, Pose::Identity(), kStep_us, TrackingStatus::kDegenerate));
    EXPECT_FALSE(camera.see({kWall}, Pose::Identity(), kStep_us, TrackingStatus::kLost));
    EXPECT_FALSE(camera.see({kWall}, Pose::Identity(), -20 * kStep_us)) << "time that goes back";
}

TEST(Looks, OfABusyPlaceAreBounded) {
    Camera camera({kWall});
    int changes = 0;
    for (int i = 0; i < 6000; ++i) {  // ten minutes
        const auto look = camera.see({kWall, plate_at(i % 2 == 0 ? -1 : 1)});
        changes += look && look->is_news();
    }
    EXPECT_LE(changes, Looks::kMostChanges + 600 / Looks::kChangeEach_s + 1);
    EXPECT_GE(changes, Looks::kMostChanges);
}

TEST(Looks, InvalidRegionsAndUnknownKeyframesSayNothing) {
    Looks looks;
    OdometryEstimate estimate;
    estimate.status = TrackingStatus::kTracked;
    estimate.utime = 5000000;
    PlanarRegion region = scene::region_of(kWall, Pose::Identity(), 0.05);
    EXPECT_FALSE(looks.see(estimate, std::vector{region}));
    looks.begin(scene::keyframe(0, {kWall}, Pose::Identity()));
    region.plane.d = std::numeric_limits<double>::quiet_NaN();
    estimate.keyframe_id = 0;
    EXPECT_FALSE(looks.see(estimate, std::vector{region}));
    for (int i = 1; i < 40; ++i) looks.begin(scene::keyframe(i, {kWall}, Pose::Identity()));
    estimate.utime = 9000000;
    EXPECT_FALSE(looks.see(estimate, std::vector{scene::region_of(kWall, Pose::Identity(), 0.05)}))
        << "keyframes of long ago are forgotten";
}

}  // namespace
}  // namespace planemap::odometry
