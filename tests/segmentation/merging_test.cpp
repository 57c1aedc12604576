// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/merging.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/geometry/angle.hpp"

namespace planemap::segmentation {
namespace {

constexpr double kCell = 0.014;  // width, normalised coordinates

MergeRules rules() {
    return {0.013, 1.9, radians(30), kCell, DepthNoise{}};
}

/// A region of columns x rows cells from normalised coordinates (x, y) on, all exactly on the plane.
MergeRegion region(const InverseDepthPlane& plane, double x, double y, int columns, int rows) {
    MergeRegion made;
    made.cells = columns * rows;
    for (int j = 0; j < 4 * rows; ++j) {
        for (int i = 0; i < 4 * columns; ++i) {
            const double px = x + kCell * (i + 0.5) / 4, py = y + kCell * (j + 0.5) / 4;
            const double Z = 1 / plane.at(px, py), X = px * Z, Y = py * Z;
            made.sums += {1, X, Y, Z, X * X, X * Y, X * Z, Y * Y, Y * Z, Z * Z};
        }
    }
    made.pixels = made.sums.n;
    made.fit = made.sums.fit();
    return made;
}

/// Touches of regions (i, i + 1), each where `linked` of ten pairs of cells continue each other.
TouchList chain(int regions, int linked) {
    TouchList touching;
    touching.clear();
    for (int r = 1; r < regions; ++r) {
        for (int k = 0; k < 10; ++k)
            touching.add(static_cast<std::uint16_t>(r), static_cast<std::uint16_t>(r + 1), k < linked, true);
    }
    return touching;
}

int count_of(const std::vector<MergeRegion>& regions) {
    int count = 0;
    for (const MergeRegion& r : regions) count += r.cells > 0 ? 1 : 0;
    return count;
}

constexpr InverseDepthPlane kWall{0.1, -0.05, 0.5};

TEST(MergingTest, HalvesOfAPlaneBecomeOne) {
    for (const int linked : {0, 10}) {
        const MergeRegion left = region(kWall, -0.14, 0, 10, 8), right = region(kWall, 0, 0, 10, 8);
        std::vector<MergeRegion> regions{left, right};
        TouchList touching = chain(2, linked);
        MergedLabels merged;
        merge_regions(rules(), regions, touching, merged);
        EXPECT_EQ(merged.find(1), 1);
        EXPECT_EQ(merged.find(2), 1);
        EXPECT_EQ(regions[0].cells, 160);
        EXPECT_EQ(regions[0].pixels, left.pixels + right.pixels);
        EXPECT_EQ(regions[0].sums.n, regions[0].pixels);
        EXPECT_NEAR(regions[0].fit.plane.a, kWall.a, 1e-9);
        EXPECT_NEAR(regions[0].fit.plane.c, kWall.c, 1e-9);
        EXPECT_EQ(regions[1].cells, 0);
        EXPECT_EQ(regions[1].pixels, 0);
        EXPECT_FALSE(regions[1].fit.valid);
        EXPECT_TRUE(touching.entries().empty());
    }
}

TEST(MergingTest, OnlyRegionsThatTouchBecomeOne) {
    std::vector<MergeRegion> regions{region(kWall, -0.14, 0, 10, 8), region(kWall, 0, 0, 10, 8)};
    TouchList touching;
    touching.clear();
    MergedLabels merged;
    merge_regions(rules(), regions, touching, merged);
    EXPECT_EQ(count_of(regions), 2);
}

TEST(MergingTest, AStepOf3CmStays) {
    for (const double z : {0.8, 1.5, 2.2}) {
        std::vector<MergeRegion> regions{region({0, 0, 1 / z}, -0.28, -0.2, 20, 20),
                                         region({0, 0, 1 / (z + 0.03)}, 0, -0.2, 20, 20)};
        TouchList touching = chain(2, 0);
        MergedLabels merged;
        merge_regions(rules(), regions, touching, merged);
        EXPECT_EQ(count_of(regions), 2) << z;
    }
}

TEST(MergingTest, WhatTheNoiseAllowsIsMoreFarAway) {
    // The same step of 3 cm is below the noise at 5 m, where a sigma is 4.1 cm.
    std::vector<MergeRegion> regions{region({0, 0, 1 / 5.0}, -0.28, -0.2, 20, 20),
                                     region({0, 0, 1 / 5.03}, 0, -0.2, 20, 20)};
    TouchList touching = chain(2, 0);
    MergedLabels merged;
    merge_regions(rules(), regions, touching, merged);
    EXPECT_EQ(count_of(regions), 1);
}

TEST(MergingTest, ACreaseStaysHoweverWellItIsLinked) {
    for (const double slope : {0.2, 0.5}) {  // the planes meet at x = 0, where 1 / z = 0.6
        std::vector<MergeRegion> regions{region({slope, 0, 0.6}, -0.28, -0.2, 20, 20),
                                         region({-slope, 0, 0.6}, 0, -0.2, 20, 20)};
        TouchList touching = chain(2, 10);
        MergedLabels merged;
        merge_regions(rules(), regions, touching, merged);
        EXPECT_EQ(count_of(regions), 2) << slope;
    }
}

TEST(MergingTest, AnInvalidFitNeverMerges) {
    std::vector<MergeRegion> regions{region(kWall, -0.14, 0, 10, 8), region(kWall, 0, 0, 10, 8),
                                     region(kWall, 0.14, 0, 10, 8)};
    regions[1].fit = {};
    TouchList touching = chain(3, 10);
    MergedLabels merged;
    merge_regions(rules(), regions, touching, merged);
    EXPECT_EQ(count_of(regions), 3);
    // Valid on their own, but together not a number.
    regions[1] = regions[2];
    regions[1].sums.xx = std::nan("");
    touching = chain(2, 10);
    merge_regions(rules(), regions, touching, merged);
    EXPECT_EQ(count_of(regions), 3);
}

TEST(MergingTest, NoiseThatIsNotFiniteMergesNothingAndEnds) {
    std::vector<MergeRegion> regions{region({0, 0, 0.5}, -0.14, 0, 10, 8), region({0, 0, 0.4}, 0, 0, 10, 8)};
    MergeRules bad = rules();
    bad.noise = {0, 0, 1e300};  // 0 times infinity
    TouchList touching = chain(2, 10);
    MergedLabels merged;
    merge_regions(bad, regions, touching, merged);
    EXPECT_EQ(count_of(regions), 2);
}

TEST(MergingTest, ChainsMergeIntoOne) {
    constexpr int kParts = 12;
    std::vector<MergeRegion> regions;
    for (int r = 0; r < kParts; ++r) regions.push_back(region(kWall, -0.3 + 4 * kCell * r, 0, 4, 6));
    TouchList touching = chain(kParts, 10);
    MergedLabels merged;
    merge_regions(rules(), regions, touching, merged);
    ASSERT_EQ(count_of(regions), 1);
    for (int r = 1; r <= kParts; ++r) EXPECT_EQ(merged.find(static_cast<std::uint16_t>(r)), 1);
    EXPECT_EQ(regions[0].cells, kParts * 24);
    EXPECT_EQ(regions[0].pixels, kParts * 24 * 16);
}

TEST(MergingTest, ChainsStopAtAStep) {
    std::vector<MergeRegion> regions;
    for (int r = 0; r < 6; ++r)
        regions.push_back(region({0, 0, 1 / (r < 3 ? 1.5 : 1.53)}, -0.2 + 4 * kCell * r, 0, 4, 20));
    TouchList touching = chain(6, 0);
    MergedLabels merged;
    merge_regions(rules(), regions, touching, merged);
    EXPECT_EQ(count_of(regions), 2);
    EXPECT_EQ(merged.find(3), 1);
    EXPECT_EQ(merged.find(6), 4);
}

TEST(MergingTest, DistanceIsAlongTheNormal) {
    const InverseDepthPlane frontal{0, 0, 0.5}, grazing{2, 0, 0.5};
    EXPECT_NEAR(distance_of(0.5 - 1 / 2.03, 2.03, frontal), 0.03, 1e-12);
    EXPECT_EQ(distance_of(-0.01, 2, frontal), distance_of(0.01, 2, frontal));
    // At the middle of the image, a step along the ray of 3 cm at 2 m, times the cosine to the normal.
    EXPECT_NEAR(distance_of(1 / 2.0 - 1 / 2.03, 2.03, grazing), 0.03 * 0.5 / grazing.steepness(), 1e-12);
}

/// Gathers with all labels up to `count` on their own.
void gather_separate(TouchList& touching, std::size_t count) {
    MergedLabels separate(count + 1);
    touching.gather(separate);
}

TEST(TouchListTest, CountsWhateverTheOrder) {
    TouchList touching;
    touching.clear();
    touching.add(1, 2, true, true);
    touching.add(2, 1, false, true);
    touching.add(2, 1, false, false);
    touching.add(3, 2, false, true);
    gather_separate(touching, 3);
    ASSERT_EQ(touching.entries().size(), 2u);
    const Touch first = touching.entries()[0], second = touching.entries()[1];
    EXPECT_THAT((std::array{int{first.a}, int{first.b}, first.linked, first.side_by_side}),
                testing::ElementsAre(1, 2, 1, 2));
    EXPECT_THAT((std::array{int{second.a}, int{second.b}, second.linked, second.side_by_side}),
                testing::ElementsAre(2, 3, 0, 1));
}

TEST(TouchListTest, PairsOfOneHashAreKeptApartAndGathered) {
    // (1, 256) and (2, 243) fall in one place: 13 a + b is 269 for both.
    TouchList touching;
    touching.clear();
    for (int k = 0; k < 5; ++k) {
        touching.add(1, 256, true, true);
        touching.add(2, 243, false, true);
    }
    gather_separate(touching, 256);
    ASSERT_EQ(touching.entries().size(), 2u);
    EXPECT_EQ(touching.entries()[0].b, 256);
    EXPECT_EQ(touching.entries()[0].linked, 5);
    EXPECT_EQ(touching.entries()[1].b, 243);
    EXPECT_EQ(touching.entries()[1].side_by_side, 5);
}

TEST(TouchListTest, GatherFollowsWhatWasMerged) {
    MergedLabels merged(5);
    TouchList touching;
    touching.clear();
    touching.add(1, 2, true, true);
    touching.add(2, 3, true, true);
    touching.add(1, 3, false, true);
    touching.add(3, 4, true, true);
    merged.join(3, 2);
    merged.join(2, 1);
    touching.gather(merged);  // all but 4 are 1
    ASSERT_EQ(touching.entries().size(), 1u);
    EXPECT_EQ(touching.entries()[0].a, 1);
    EXPECT_EQ(touching.entries()[0].b, 4);
    EXPECT_EQ(touching.entries()[0].linked, 1);
}

TEST(TouchListTest, ClearForgetsAll) {
    TouchList touching;
    touching.clear();
    touching.add(1, 2, true, true);
    touching.clear();
    EXPECT_TRUE(touching.entries().empty());
    touching.add(1, 2, true, true);
    gather_separate(touching, 2);
    ASSERT_EQ(touching.entries().size(), 1u);
    EXPECT_EQ(touching.entries()[0].linked, 1);
}

}  // namespace
}  // namespace planemap::segmentation
