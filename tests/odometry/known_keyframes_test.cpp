// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/known_keyframes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace planemap::odometry {
namespace {

/// Waves of one direction and length; others for other numbers.
GrayImage pattern(int number, double contrast = 60, double light = 120) {
    GrayImage image(160, 120);
    for (int v = 0; v < 120; ++v)
        for (int u = 0; u < 160; ++u)
            image(u, v) = static_cast<std::uint8_t>(
                light + contrast * std::sin(0.05 * number * u + 0.3 * std::cos(number) * v));
    return image;
}

KnownKeyframe keyframe(int id, double x, int number = 1) {
    KnownKeyframe known;
    known.id = id;
    known.odom_from_keyframe.translation().x() = x;
    known.thumbnail = make_thumbnail(pattern(number));
    return known;
}

std::vector<int> ids(const std::vector<const KnownKeyframe*>& keyframes) {
    std::vector<int> ids;
    for (const KnownKeyframe* known : keyframes) ids.push_back(known->id);
    return ids;
}

TEST(ThumbnailTest, LightAndContrastDoNotMatter) {
    const std::vector<float> a = make_thumbnail(pattern(2)), b = make_thumbnail(pattern(2, 30, 90));
    ASSERT_EQ(a.size(), b.size());
    double norm = 0, likeness = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        norm += static_cast<double>(a[i] * a[i]);
        likeness += static_cast<double>(a[i] * b[i]);
    }
    EXPECT_NEAR(norm, 1, 1e-4);
    EXPECT_GT(likeness, 0.99);
}

TEST(ThumbnailTest, OneShadeIsAllZero) {
    for (const float value : make_thumbnail(GrayImage(160, 120, 77))) EXPECT_EQ(value, 0);
}

TEST(KnownKeyframesTest, TheNewestComesFirstThenTheMostAlike) {
    KnownKeyframes known(10);
    for (int i = 1; i <= 4; ++i) known.add(keyframe(i, i, i));
    EXPECT_EQ(ids(known.candidates(pattern(2), 2)), (std::vector{4, 2}));
    EXPECT_EQ(ids(known.candidates(pattern(3), 2)), (std::vector{4, 3}));
    EXPECT_EQ(known.candidates(pattern(3), 100).size(), 4u);
}

TEST(KnownKeyframesTest, NoneAreNone) {
    KnownKeyframes known(10);
    EXPECT_TRUE(known.candidates(pattern(1), 5).empty());
    known.add(keyframe(0, 0));
    EXPECT_TRUE(known.candidates(pattern(1), 0).empty());
    known.clear();
    EXPECT_TRUE(known.candidates(pattern(1), 5).empty());
}

TEST(KnownKeyframesTest, OfTheNearestTwoTheOlderGoes) {
    KnownKeyframes known(14);
    // 0, 1, 2, 3 a metre apart but for 2, which is near 1; then more than ten far ones.
    known.add(keyframe(0, 0));
    known.add(keyframe(1, 1));
    known.add(keyframe(2, 1.1));
    known.add(keyframe(3, 3));
    for (int i = 4; i < 15; ++i) known.add(keyframe(i, 10 * i));
    const std::vector<int> left = ids(known.candidates(pattern(1), 100));
    EXPECT_EQ(left.size(), 14u);
    EXPECT_EQ(std::count(left.begin(), left.end(), 1), 0);
    EXPECT_EQ(std::count(left.begin(), left.end(), 2), 1);
}

TEST(KnownKeyframesTest, TheNewestTenStay) {
    KnownKeyframes known(12);
    for (int i = 0; i < 40; ++i) {
        known.add(keyframe(i, 0));  // all in one place
        const std::vector<int> left = ids(known.candidates(pattern(1), 100));
        EXPECT_LE(left.size(), 12u);
        const std::set<int> stay(left.begin(), left.end());
        for (int k = std::max(0, i - 9); k <= i; ++k) EXPECT_TRUE(stay.contains(k)) << k << " of " << i;
    }
}

TEST(KnownKeyframesTest, ASmallCapacityIsKept) {
    KnownKeyframes known(1);
    for (int i = 0; i < 5; ++i) known.add(keyframe(i, i));
    EXPECT_EQ(known.candidates(pattern(1), 100).size(), 1u);
}

}  // namespace
}  // namespace planemap::odometry
