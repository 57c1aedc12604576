// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random_values.hpp"
#include "core/two_cameras.hpp"

namespace planemap {
namespace {

using test::Random;

CameraInfo unregistered(Random& random) {
    CameraInfo info;
    info.registered = false;
    info.depth = {160, 120, 145, 147, 81.3, 58.2};
    info.color = {150, 130, 131, 132, 74.1, 66.0};
    info.depth_units_per_metre = 5000;
    Twist twist;
    twist << random.vector(0.05), random.direction() * 0.03;
    info.color_from_depth = pose_from_twist(twist);
    return info;
}

DepthImage random_depth(Random& random, const PinholeCamera& camera) {
    DepthImage depth(camera.width, camera.height);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const double z = u > 60 && u < 100 ? 0.9 : 2.0 + 0.01 * v;  // a pillar before a sloping wall
            depth(u, v) = static_cast<std::uint16_t>(5000 * z + random.uniform(0, 20));
            const int luck = random.integer(0, 19);
            if (luck < 2) depth(u, v) = luck == 0 ? 0 : 65535;
        }
    }
    return depth;
}

/// The definition, in double precision and metres.
DepthImage brute_force(const DepthImage& depth, const CameraInfo& info) {
    DepthImage out(info.color.width, info.color.height);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            if (!is_valid_depth(depth(u, v))) continue;
            const Eigen::Vector3d p =
                info.color_from_depth * info.depth.unproject(u, v, info.metres(depth(u, v)));
            const Eigen::Vector2d pixel = info.color.project(p);
            const int x = static_cast<int>(std::floor(pixel.x() + 0.5)),
                      y = static_cast<int>(std::floor(pixel.y() + 0.5));
            if (p.z() <= 0 || !out.contains(x, y)) continue;
            const auto z = static_cast<std::uint16_t>(std::lround(p.z() * info.depth_units_per_metre));
            if (out(x, y) == 0 || z < out(x, y)) out(x, y) = z;
        }
    }
    return out;
}

TEST(Registration, AgreesWithBruteForce) {
    Random random(1);
    for (int i = 0; i < 5; ++i) {
        const CameraInfo info = unregistered(random);
        const DepthImage depth = random_depth(random, info.depth);
        const DepthImage ours = register_depth(depth, info), truth = brute_force(depth, info);
        ASSERT_EQ(ours.width, truth.width);
        ASSERT_EQ(ours.height, truth.height);
        int differ = 0, landed = 0;
        for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
            landed += truth.pixels[k] != 0;
            differ += std::abs(ours.pixels[k] - truth.pixels[k]) > 1;
        }
        EXPECT_GT(landed, 8000);
        EXPECT_LE(differ, landed / 500) << "a few pixels may round to their neighbour";
    }
}

TEST(Registration, RegisteredDepthIsReturnedAsItIs) {
    Random random(2);
    CameraInfo info = unregistered(random);
    info.registered = true;
    info.color = info.depth;
    const DepthImage depth = random_depth(random, info.depth);
    EXPECT_EQ(register_depth(depth, info).pixels, depth.pixels);
}

TEST(Registration, RegisteredDepthOfAnotherSizeIsScaled) {
    CameraInfo info;
    info.depth = {80, 60, 70, 70, 39.5, 29.5};
    info.color = {40, 30, 35, 35, 19.5, 14.5};
    const DepthImage half = register_depth(DepthImage(80, 60, 1234), info);
    EXPECT_EQ(half.width, 40);
    for (const auto raw : half.pixels) EXPECT_EQ(raw, 1234);
}

/// Ratios of the depth camera's focal lengths to the colour camera's.
struct Ratio {
    double x, y;
};
const std::vector<Ratio> kRatios{{0.3, 0.3}, {0.5, 0.5},   {0.62, 0.62}, {0.8, 0.8}, {0.95, 0.95}, {1, 1},
                                 {1.1, 1.1}, {1.25, 1.25}, {1.5, 1.5},   {2, 2},     {4, 4},       {0.5, 0.8},
                                 {0.9, 1.2}, {2, 1.1},     {0.3, 4},     {4, 0.3}};

void expect_filled(const Ratio& ratio, const CameraInfo& info, double slant, double noise, Random& random) {
    const test::Scene scene = test::Scene::room(slant);
    const test::Sensed sensed = test::sense(scene, info, noise, random);
    const test::Registered result = test::compare(scene, info, sensed, register_depth(sensed.depth, info));
    SCOPED_TRACE(testing::Message() << "ratio " << ratio.x << ", " << ratio.y << ", slant " << slant
                                    << ", noise " << noise << ", rms " << result.rms << ", mean "
                                    << result.mean);
    EXPECT_GT(result.inside, info.color.width * info.color.height / 4);
    EXPECT_LE(result.holes, 0.02 * result.inside);
    EXPECT_EQ(result.beyond, 0);
    EXPECT_LE(result.wrong, 0.001 * result.inside);
    // Where pixels are as coarse as readings a reading's depth stands for the whole pixel.
    EXPECT_LT(result.rms, 0.6 + noise);
    EXPECT_LT(std::abs(result.mean), 0.3);
}

TEST(Registration, SurfacesHaveNoHolesAndEndAtTheirEdgesAtAnyRatio) {
    Random random(5);
    for (const Ratio& ratio : kRatios) {
        for (const double slant : {-1.0, 0.0, 0.7}) {
            for (const double noise : {0.0, 1.0})
                expect_filled(ratio, test::two_cameras(ratio.x, ratio.y, random), slant, noise, random);
        }
    }
}

TEST(Registration, ATurnedColourCameraHasNoHoles) {
    Random random(6);
    for (const double turn : {0.04, 0.08, 0.3, 0.8, 1.57}) {
        for (const double ratio : {0.5, 0.9, 1.0, 1.2, 1.6}) {
            CameraInfo info = test::two_cameras(ratio, ratio, random, 0.03, 0.0);
            info.color_from_depth.linear() = so3_exp({0, 0, turn});
            expect_filled({ratio, ratio}, info, 0.3, 1.0, random);
        }
    }
}

TEST(Registration, ASurfaceThatTheBaselineStretchesHasNoHoles) {
    Random random(7);
    for (const double ratio : {1.0, 1.1, 1.25}) {
        CameraInfo info = test::two_cameras(ratio, ratio, random, 0.0, 0.0);
        info.color_from_depth.translation() = Eigen::Vector3d(-0.06, 0, 0);
        info.depth_min_m = 0.1;
        // A wall beside the cameras, 0.4 m from them: the colour camera sees it 15 % wider.
        const Eigen::Vector3d normal(-std::cos(0.25), 0, -std::sin(0.25));
        const test::Scene scene = test::Scene::of({normal, 0.4});
        const test::Sensed sensed = test::sense(scene, info, 0.3, random);
        const test::Registered result =
            test::compare(scene, info, sensed, register_depth(sensed.depth, info));
        EXPECT_GT(result.inside, 500) << ratio;
        EXPECT_LE(result.holes, 0.02 * result.inside) << ratio;
        EXPECT_EQ(result.beyond, 0) << ratio;
    }
}

TEST(Registration, AGrazingFloorIsWhole) {
    Random random(8);
    for (const double ratio : {0.3, 0.62, 1.0, 2.0, 4.0}) {
        const CameraInfo info = test::two_cameras(ratio, ratio, random, 0.02, 0.0);
        const test::Scene scene =
            test::Scene::of({{0, -1, 0}, 0.25});  // under a low robot, seen until depth_max_m
        const test::Sensed sensed = test::sense(scene, info, 0.5, random);
        const test::Registered result =
            test::compare(scene, info, sensed, register_depth(sensed.depth, info));
        EXPECT_GT(result.inside, info.color.width * info.color.height / 5) << ratio;
        EXPECT_LE(result.holes, 0.02 * result.inside) << ratio;
        EXPECT_EQ(result.beyond, 0) << ratio;
        // Where pixels are as coarse as readings a row's depth stands for the whole pixel.
        EXPECT_LT(result.rms, ratio == 1 ? 2 : 1) << "ratio " << ratio << ", mean " << result.mean;
        EXPECT_LT(std::abs(result.mean), ratio == 1 ? 0.6 : 0.2) << ratio;
    }
}

TEST(Registration, ManyReadingsAPixelAreAveragedNotTheNearestTaken) {
    Random random(9);
    CameraInfo info = test::two_cameras(4, 4, random, 0.0, 0.0);
    const test::Scene wall = test::Scene::of({{0, 0, -1}, 3});
    const test::Sensed sensed = test::sense(wall, info, 1, random);
    const test::Registered result = test::compare(wall, info, sensed, register_depth(sensed.depth, info));
    EXPECT_LT(std::abs(result.mean), 0.1);
    EXPECT_LT(result.rms, 0.5) << "the mean of 16";
}

TEST(Registration, AMixedReadingIsNotABridge) {
    // Half of a reading at an edge saw the front and half the back: it is none of both, and nothing is filled
    // between them but its own footprint.
    Random random(10);
    CameraInfo info = test::two_cameras(0.5, 0.5, random, 0.0, 0.0);
    info.color_from_depth.translation() = Eigen::Vector3d(-0.05, 0, 0);
    DepthImage depth(info.depth.width, info.depth.height);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) depth(u, v) = u < 100 ? 5000 : u == 100 ? 7500 : 15000;
    }
    const DepthImage registered = register_depth(depth, info);
    const int line = registered.height / 2;
    int mixed = 0;
    for (int u = 0; u < registered.width; ++u)
        mixed += registered(u, line) > 5300 && registered(u, line) < 14500;
    EXPECT_GE(mixed, 1);
    EXPECT_LE(mixed, 3);
}

TEST(Registration, AHostileTransformCostsNoMoreThanAnother) {
    // Each reading would fill the whole colour image.
    CameraInfo info;
    info.depth = {320, 240, 300, 300, 160, 120};
    info.color = {900, 700, 900, 900, 450, 350};
    info.registered = false;
    info.color_from_depth.translation().z() = -0.999;
    const DepthImage registered = register_depth(DepthImage(320, 240, 1000), info);
    EXPECT_EQ(registered.width, 900);
}

TEST(Registration, InvalidDepthStaysInvalid) {
    Random random(3);
    const CameraInfo info = unregistered(random);
    for (const std::uint16_t raw : {std::uint16_t{0}, std::uint16_t{65535}}) {
        const DepthImage out = register_depth(DepthImage(160, 120, raw), info);
        for (const auto pixel : out.pixels) EXPECT_EQ(pixel, 0);
    }
}

TEST(Registration, WhatFallsBehindTheColourCameraIsLeftOut) {
    Random random(4);
    CameraInfo info = unregistered(random);
    info.color_from_depth.translation().z() = -3;
    for (const auto pixel : register_depth(DepthImage(160, 120, 10000), info).pixels) EXPECT_EQ(pixel, 0);
    info.color_from_depth.translation().z() = 1e6;
    for (const auto pixel : register_depth(DepthImage(160, 120, 10000), info).pixels) EXPECT_EQ(pixel, 0);
}

}  // namespace
}  // namespace planemap
