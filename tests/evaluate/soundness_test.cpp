// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/soundness.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "core/cloud_point.hpp"
#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kY = Eigen::Vector3d::UnitY(),
                      kZ = Eigen::Vector3d::UnitZ();

CameraInfo sensor() {
    CameraInfo info;
    info.depth = {160, 120, 131, 131, 79.5, 59.5};
    info.color = info.depth;
    return info;
}

/// Depth of a camera at the origin that looks along z; `depth_at` gives metres along a pixel's ray.
DepthView view_of(const std::function<double(int u, int v)>& depth_at) {
    const CameraInfo info = sensor();
    DepthImage depth(info.depth.width, info.depth.height);
    for (int v = 0; v < depth.height; ++v)
        for (int u = 0; u < depth.width; ++u)
            depth(u, v) = static_cast<std::uint16_t>(std::lround(1000 * depth_at(u, v)));
    return DepthView(depth, info, 0, 160);
}

DepthView wall_at(double z) {
    return view_of([z](int, int) { return z; });
}

/// A wall across the camera's axis, seen from the origin.
Face wall(double z, double half_x = 0.5, double half_y = 0.4) {
    return {"wall", {0, 0, z}, -kZ, kX, half_x, half_y};
}

PlaneMap map_of_faces(const std::vector<Face>& faces) {
    PlaneMap map;
    int id = 1;
    for (const Face& face : faces) map.planes.push_back(map_plane(id++, face));
    return map;
}

std::vector<PosedView> times(const DepthView& view, int count) {
    return std::vector<PosedView>(static_cast<std::size_t>(count), PosedView{&view, Pose::Identity()});
}

TEST(Soundness, AWallAtItsPlaceIsSound) {
    const DepthView view = wall_at(2);
    const Soundness sound = soundness(map_of_faces({wall(2, 2, 2)}), times(view, 3));
    EXPECT_EQ(sound.doubled_share(), 0.0);
    EXPECT_EQ(sound.floating_share(), 0.0);
    EXPECT_EQ(sound.counts.share_of(&ReadingCounts::explained), 1.0);
    EXPECT_NEAR(sound.residuals.rms_m, 0, 1e-6);
    EXPECT_NEAR(sound.area_m2, 16, 0.1);
    EXPECT_NEAR(sound.seen_m2, 2 * 2 * 160. * 120 / 131 / 131, 0.2);
    ASSERT_EQ(sound.by_range.size(), 1u);
    EXPECT_EQ(sound.by_range[0].from_m, 2);
}

TEST(Soundness, AWallThatStandsTwiceIsDoubledOnce) {
    const DepthView view = wall_at(2);
    Face again = wall(2.08, 0.25, 0.4);
    const Soundness sound = soundness(map_of_faces({wall(2), again}), times(view, 9));
    EXPECT_NEAR(sound.doubled_m2, 0.5 * 0.8, 0.03);
    EXPECT_NEAR(*sound.doubled_share(), 0.4 / 1.2, 0.02);
    ASSERT_EQ(sound.doubled.size(), 1u);
    EXPECT_EQ(sound.doubled[0].id_a, 2);
    EXPECT_EQ(sound.doubled[0].id_b, 1);
    // A third one within the first two doubles no point of the second again.
    const Soundness thrice = soundness(map_of_faces({wall(2), again, wall(2.04, 0.1, 0.1)}), times(view, 9));
    EXPECT_NEAR(thrice.doubled_m2, 0.5 * 0.8 + 0.2 * 0.2, 0.04);
}

TEST(Soundness, FarApartTurnedAwayOrAtAnAngleIsNotDoubled) {
    Face away = wall(2.05), turned = wall(2.05);
    away.normal = kZ;
    turned.normal = {std::sin(radians(14)), 0, -std::cos(radians(14))};
    turned.x = {std::cos(radians(14)), 0, std::sin(radians(14))};
    for (const Face& other : {wall(2.2), away, turned})
        EXPECT_EQ(soundness(map_of_faces({wall(2), other}), {}).doubled_m2, 0);
}

/// A board 8 cm before a wall: one view of it may be a fault, three are two surfaces.
TEST(Soundness, WhatThreeViewsSawSideBySideIsTwo) {
    const DepthView view = view_of([](int u, int) { return u < 80 ? 1.42 : 1.5; });
    const PlaneMap map = map_of_faces({wall(1.42), wall(1.5)});
    EXPECT_GT(soundness(map, times(view, 2)).doubled_m2, 0.5);
    EXPECT_EQ(soundness(map, times(view, 3)).doubled_m2, 0);
}

/// Noise of 2 cm throws single readings to either of two planes 5 cm apart: that makes them no two surfaces.
TEST(Soundness, NoiseDoesNotTellTwoSurfacesApart) {
    const DepthView view = view_of([](int u, int v) { return 4 + ((u * 7 + v * 3) % 5 - 2) * 0.02; });
    EXPECT_GT(soundness(map_of_faces({wall(3.975), wall(4.025)}), times(view, 9)).doubled_m2, 0.5);
}

TEST(Soundness, WhatWasLookedThroughFloats) {
    const DepthView behind = wall_at(2.2), on_it = wall_at(2);
    const PlaneMap map = map_of_faces({wall(2)});
    std::vector<PosedView> views = times(behind, 3);
    EXPECT_EQ(soundness(map, views).floating_share(), 1.0);
    EXPECT_EQ(soundness(map, views).counts.explained, 0);
    for (const PosedView& view : times(on_it, 3)) views.push_back(view);
    EXPECT_EQ(soundness(map, views).floating_share(), 0.0);  // half of the views is not more than half
    EXPECT_EQ(soundness(map, times(wall_at(2.04), 3)).floating_share(), 0.0);
}

TEST(Soundness, UnseenAndFromBehindCountsNowhere) {
    const DepthView view = wall_at(2);
    Face back = wall(1.5);
    back.normal = kZ;
    for (const Face& face : {Face{"side", {5, 0, 2}, -kX, kY, 1, 1}, back}) {
        const Soundness sound = soundness(map_of_faces({face}), times(view, 3));
        EXPECT_EQ(sound.seen_m2, 0);
        EXPECT_FALSE(sound.floating_share());
    }
    EXPECT_FALSE(soundness({}, {}).doubled_share());
    EXPECT_FALSE(soundness({}, {}).counts.share_of(&ReadingCounts::explained));
    EXPECT_EQ(soundness({}, times(view, 1)).counts.share_of(&ReadingCounts::explained), 0.0);
}

TEST(Soundness, BiasIsPositiveBeforeThePlane) {
    const Soundness sound = soundness(map_of_faces({wall(2, 2, 2)}), times(wall_at(1.99), 1));
    EXPECT_NEAR(sound.residuals.mean_m, 0.01, 1e-6);
    EXPECT_NEAR(sound.planes[0].residuals.mean_m, 0.01, 1e-6);
}

/// A wall of which the left half of the views is 3 cm behind it, and a quarter 1.2 cm.
TEST(Soundness, CountsReadingsByTheirDistanceAndDepth) {
    const DepthView view = view_of([](int u, int) { return u < 80 ? 1.03 : u < 120 ? 1.012 : 1.0; });
    const Soundness sound = soundness(map_of_faces({wall(1, 2, 2)}), times(view, 2));
    ASSERT_EQ(sound.counts.readings, 2 * 160 * 120);
    EXPECT_EQ(sound.counts.share_of(&ReadingCounts::close), 0.5);
    EXPECT_EQ(sound.counts.share_of(&ReadingCounts::explained), 0.5);  // 3 sigma are 6 mm: 1.5 cm
    EXPECT_EQ(sound.counts.share_of(&ReadingCounts::near), 1.0);
    ASSERT_EQ(sound.by_range.size(), 1u);
    EXPECT_EQ(sound.by_range[0].counts.readings, sound.counts.readings);
    const DepthView two = view_of([](int u, int) { return u < 40 ? 1.5 : 3.5; });
    const Soundness ranges = soundness(map_of_faces({wall(1.5, 2, 2)}), times(two, 1));
    ASSERT_EQ(ranges.by_range.size(), 2u);
    EXPECT_EQ(ranges.by_range[0].counts.share_of(&ReadingCounts::close), 1.0);
    EXPECT_EQ(ranges.by_range[1].counts.share_of(&ReadingCounts::close), 0.0);
    EXPECT_EQ(ranges.by_range[1].counts.readings, 120 * 120);
}

/// Of a wall of 4 m x 4 m one view sees 2.44 m x 1.83 m, with a reading on it in the right half of that.
TEST(Soundness, OutlinesAreConfirmedWhereAReadingIsOnThem) {
    const DepthView view = view_of([](int u, int) { return u < 80 ? 2.2 : 2; });
    const Soundness sound = soundness(map_of_faces({wall(2, 2, 2)}), times(view, 1));
    EXPECT_NEAR(*sound.confirmed_share(), 0.5 * 4 * 160. * 120 / 131 / 131 / 16, 0.005);
    // Where one of two views has it, it is confirmed.
    const DepthView other = view_of([](int u, int) { return u < 80 ? 2 : 2.2; });
    const Soundness both =
        soundness(map_of_faces({wall(2, 2, 2)}), {{&view, Pose::Identity()}, {&other, Pose::Identity()}});
    EXPECT_NEAR(*both.confirmed_share(), 4 * 160. * 120 / 131 / 131 / 16, 0.01);
    EXPECT_FALSE(soundness({}, times(view, 1)).confirmed_share());
}

TEST(Soundness, TheListenerHearsEveryReadingAsItWasJudged) {
    const DepthView view = view_of([](int u, int) { return u < 40 ? 1.0 : u < 80 ? 1.03 : 1.2; });
    std::int64_t readings = 0, explained = 0, near = 0;
    soundness(map_of_faces({wall(1, 2, 2)}), times(view, 2), {}, [&](const JudgedReading& reading) {
        ++readings;
        explained += reading.is_explained;
        near += reading.is_near;
        EXPECT_EQ(reading.face == nullptr, reading.range_m > 1.1);
        EXPECT_NEAR(reading.distance_m, reading.face != nullptr ? 1 - reading.p_world.z() : 0, 1e-6);
    });
    EXPECT_EQ(readings, 2 * 160 * 120);
    EXPECT_EQ(explained, readings / 4);
    EXPECT_EQ(near, readings / 2);
}

TEST(SpreadViews, KeepsFewOfManyEvenly) {
    const CameraInfo info = sensor();
    const DepthImage depth(info.depth.width, info.depth.height, 2000);
    SpreadViews views;
    for (int i = 0; i < 1000; ++i) views.add(depth, info, i);
    const auto& kept = views.views();
    EXPECT_LE(kept.size(), SpreadViews::kMost);
    EXPECT_GE(kept.size(), SpreadViews::kMost / 2);
    for (std::size_t i = 1; i < kept.size(); ++i)
        EXPECT_EQ(kept[i].utime - kept[i - 1].utime, kept[1].utime - kept[0].utime);
}

/// A colour camera 10 cm beside the depth camera: a reading has the colour of what it is, not of its pixel.
TEST(DepthView, ReadingsHaveTheirColour) {
    CameraInfo info = sensor();
    info.color = {320, 240, 262, 262, 159.5, 119.5};
    info.registered = false;
    info.color_from_depth.translation().x() = -0.1;
    DepthImage depth(160, 120, 1000);
    depth(0, 0) = 0;
    RgbImage picture(80, 60);  // a fourth of the colour image: red tells the column, green the row
    for (int v = 0; v < 60; ++v)
        for (int u = 0; u < 80; ++u)
            picture(u, v) = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 7};
    const DepthView view(depth, info, 0, 160, picture);
    EXPECT_EQ(view.readings, 160u * 120 - 1);
    for (const int u : {40, 80, 159}) {
        // Twice the pixel, moved by 262 * 0.1 / 1 pixels; then four to one.
        const int x = static_cast<int>(std::floor((2 * (u + 0.5) - 26.2) / 4));
        EXPECT_EQ(view.colors(u, 60).r, x) << u;
        EXPECT_EQ(view.colors(u, 60).g, 30);
    }
    EXPECT_EQ(view.colors(5, 60), CloudPoint::kNoColor) << "beside the colour image";
    EXPECT_EQ(view.colors(0, 0), CloudPoint::kNoColor) << "no reading";
    EXPECT_EQ(DepthView(depth, info, 0, 160).colors(80, 60), CloudPoint::kNoColor);
}

TEST(SpreadViews, AsksForPicturesOfWhatItKeepsAlone) {
    CameraInfo info = sensor();
    info.color.width = 640;
    info.color.height = 480;
    int asked = 0;
    SpreadViews views;
    for (int i = 0; i < 1000; ++i) {
        views.add(DepthImage(160, 120, 1000), info, i, [&](int reduction) -> std::optional<RgbImage> {
            ++asked;
            EXPECT_EQ(reduction, 4);
            return std::nullopt;
        });
    }
    EXPECT_LT(asked, 300);
}

TEST(DepthView, ThinnedPixelsLookWhereTheyDid) {
    CameraInfo info = sensor();
    info.depth = {641, 479, 525, 525, 320.5, 240.1};
    DepthImage depth(641, 479);
    for (int v = 0; v < 479; ++v)
        for (int u = 0; u < 641; ++u) depth(u, v) = static_cast<std::uint16_t>(1000 + u + 2 * v);
    const DepthView view(depth, info, 0, 160);
    EXPECT_LE(view.metres.width, 160);
    for (const int u : {0, 7, view.metres.width - 1}) {
        const int v = 5;
        const double raw = std::round(1000 * static_cast<double>(view.metres(u, v))) - 1000;
        // The ray of the thinned pixel is that of a pixel whose reading it has.
        const Eigen::Vector3d ray = view.camera.unproject(u, v, 1);
        const Eigen::Vector2d pixel = info.depth.project(ray);
        EXPECT_NEAR(raw, pixel.x() + 2 * pixel.y(), 1e-6);
    }
}

}  // namespace
}  // namespace planemap::evaluation
