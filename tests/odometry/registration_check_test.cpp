// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/registration_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace planemap::odometry {
namespace {

constexpr int kWidth = 320, kHeight = 240, kEnough = 20;

struct Frame {
    DepthImage depth{kWidth, kHeight, 3000};
    GrayImage gray{kWidth, kHeight, 90};
};

/// Boxes in front of a wall, each of a brightness of its own, which colour sees at x + shift + stretch * (x
/// from the middle, in widths of the image).
Frame boxes(std::mt19937_64& random, double shift_px, double stretch_px) {
    Frame frame;
    std::uniform_int_distribution<int> left(0, kWidth - 50), top(0, kHeight - 50), size(20, 45), gray(0, 255);
    for (int i = 0; i < 9; ++i) {
        const int u0 = left(random), v0 = top(random), u1 = u0 + size(random), v1 = v0 + size(random);
        const auto brightness = static_cast<std::uint8_t>(gray(random));
        const auto seen = [&](int u) {
            return std::clamp(static_cast<int>(std::lround(
                                  u + shift_px + stretch_px * (static_cast<double>(u) / kWidth - 0.5))),
                              0, kWidth);
        };
        for (int v = v0; v < v1; ++v) {
            std::fill(frame.depth.row(v) + u0, frame.depth.row(v) + u1, std::uint16_t{1500});
            std::fill(frame.gray.row(v) + seen(u0), frame.gray.row(v) + seen(u1), brightness);
        }
    }
    return frame;
}

RegistrationCheck seen(double shift_px, double stretch_px) {
    std::mt19937_64 random(5);
    RegistrationCheck check;
    for (int i = 1; i <= kEnough; ++i) {
        const Frame frame = boxes(random, shift_px, stretch_px);
        EXPECT_EQ(check.see(500000 * i, frame.depth, frame.gray), i == kEnough);
    }
    return check;
}

TEST(RegistrationCheck, EdgesInPlaceAreNoComplaint) {
    for (const double shift : {0, 2, -3}) {
        const RegistrationCheck check = seen(shift, 0);
        ASSERT_TRUE(check.displacement());
        EXPECT_NEAR(check.displacement()->shift_px, shift, 2);
        EXPECT_FALSE(check.complaint()) << *check.complaint();
    }
}

/// A Kinect v1's without registration, at half the resolution: a shift by the parallax, and another focal
/// length.
TEST(RegistrationCheck, EdgesThatAreDisplacedAreTold) {
    for (const auto& [shift, stretch] : {std::pair(-5, -37), std::pair(9, 0), std::pair(-12, 16)}) {
        const RegistrationCheck check = seen(shift, stretch);
        ASSERT_TRUE(check.displacement());
        EXPECT_NEAR(check.displacement()->shift_px, shift, 2);
        EXPECT_NEAR(check.displacement()->stretch_px, stretch, 8);
        ASSERT_TRUE(check.complaint()) << shift;
        EXPECT_THAT(*check.complaint(), testing::HasSubstr("px beside colour's"));
    }
}

TEST(RegistrationCheck, WhatShowsNoEdgesSaysNothing) {
    std::mt19937_64 random(6);
    RegistrationCheck flat, dark, noise, elsewhere;
    for (int i = 1; i <= kEnough; ++i) {
        Frame frame = boxes(random, 0, 0);
        flat.see(500000 * i, DepthImage(kWidth, kHeight, 2000), frame.gray);
        dark.see(500000 * i, frame.depth, GrayImage(kWidth, kHeight));
        elsewhere.see(500000 * i, frame.depth, boxes(random, 0, 0).gray);
        for (std::uint8_t& pixel : frame.gray.pixels) pixel = static_cast<std::uint8_t>(random() % 256);
        noise.see(500000 * i, frame.depth, frame.gray);
    }
    EXPECT_FALSE(flat.displacement());
    for (const RegistrationCheck* check : {&flat, &dark, &noise, &elsewhere})
        EXPECT_FALSE(check->complaint()) << *check->complaint();
}

TEST(RegistrationCheck, LooksTwiceASecondAndOnlyAtImagesOfOneSize) {
    std::mt19937_64 random(7);
    const Frame frame = boxes(random, 0, 0);
    RegistrationCheck check;
    int looks = 0;
    for (int i = 1; i <= 1000; ++i) looks += check.see(33333 * i, frame.depth, frame.gray);
    EXPECT_EQ(looks, 1) << "it has seen enough once";
    RegistrationCheck other;
    for (int i = 1; i <= 100; ++i)
        EXPECT_FALSE(other.see(500000 * i, frame.depth, GrayImage(kWidth / 2, kHeight / 2)));
}

}  // namespace
}  // namespace planemap::odometry
