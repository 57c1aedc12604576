// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random_values.hpp"

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
