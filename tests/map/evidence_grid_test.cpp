// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_grid.hpp"

#include <gtest/gtest.h>

#include <random>

#include "map/scene.hpp"

namespace planemap {
namespace {

using scene::rectangle_ring;

TEST(EvidenceGrid, HasTheAreaOfWhatWasAdded) {
    EvidenceGrid grid(Pose::Identity(), 0.025);
    grid.add(Outline{{rectangle_ring(-1, -0.5, 1, 0.5), rectangle_ring(-0.2, -0.2, 0.2, 0.2)}});
    const Outline outline = grid.outline({});
    EXPECT_EQ(outline.rings.size(), 2u);
    EXPECT_NEAR(area(outline), 2 - 0.16, 0.03);
    EXPECT_FALSE(contains(outline, {0, 0}));
    EXPECT_TRUE(contains(outline, {0.5, 0.3}));
}

TEST(EvidenceGrid, FillsTheCellsThatFillDoes) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> c(-0.9, 0.9);
    for (int trial = 0; trial < 20; ++trial) {
        Outline outline{{Ring{}}};
        for (int i = 0; i < 9; ++i) outline.rings[0].emplace_back(c(random), c(random));
        EvidenceGrid grid(Pose::Identity(), 0.05);
        grid.add(outline);
        Outline in_cells = outline;
        for (auto& v : in_cells.rings[0]) v = v / 0.05 + Eigen::Vector2d(20, 20);
        Mask mask(40, 40);
        fill(in_cells, mask);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                EXPECT_EQ(grid.views({0.05 * (x - 19.5), 0.05 * (y - 19.5)}), mask.at(x, y) ? 1 : 0);
    }
}

TEST(EvidenceGrid, GrowsAndCountsViews) {
    EvidenceGrid grid(Pose::Identity(), 0.05);
    grid.add(Outline{{rectangle_ring(0, 0, 1, 1)}});
    grid.add(Outline{{rectangle_ring(0.5, 0, 3, 1)}});
    grid.add(Outline{{rectangle_ring(-2, -2, -1, -1)}});
    EXPECT_EQ(grid.views({0.2, 0.5}), 1);
    EXPECT_EQ(grid.views({0.7, 0.5}), 2);
    EXPECT_EQ(grid.views({2.7, 0.5}), 1);
    EXPECT_EQ(grid.views({-1.5, -1.5}), 1);
    EXPECT_EQ(grid.views({-0.5, -0.5}), 0);
    EXPECT_EQ(grid.views({1e9, -1e9}), 0);
    OutlineOptions twice;
    twice.min_views = 2;
    EXPECT_NEAR(area(grid.outline(twice)), 0.5, 1e-9);
    EXPECT_NEAR(area(grid.outline({})), 4, 1e-9);
    for (int i = 0; i < 300; ++i) grid.add(Outline{{rectangle_ring(0, 0, 1, 1)}});
    EXPECT_EQ(grid.views({0.2, 0.5}), 255);
}

TEST(EvidenceGrid, AddsAnotherGridInAnotherFrame) {
    const Outline shape{{rectangle_ring(-1, -0.5, 1, 0.5), rectangle_ring(0.1, -0.2, 0.5, 0.2)}};
    EvidenceGrid other(scene::facing({0.3, 0.2, 0}, {0, 0, 1}, {0.8, 0.6, 0}), 0.025);
    other.add(shape);
    EvidenceGrid grid(Pose::Identity(), 0.025);
    grid.add(other);
    EXPECT_NEAR(area(grid.outline({})), area(shape), 0.05);
    const Eigen::Vector3d hole = other.world_from_grid() * Eigen::Vector3d(0.3, 0, 0);
    EXPECT_EQ(grid.views(hole.head<2>()), 0);
    grid.add(EvidenceGrid(Pose::Identity(), 0.025));
    EXPECT_NEAR(area(grid.outline({})), area(shape), 0.05);
}

TEST(EvidenceGrid, LeavesOutSmallPartsAndHoles) {
    EvidenceGrid grid(Pose::Identity(), 0.025);
    grid.add(Outline{{rectangle_ring(0, 0, 1, 1), rectangle_ring(0.4, 0.4, 0.475, 0.475),
                      rectangle_ring(2, 0, 2.075, 0.075)}});
    const Outline outline = grid.outline({});
    EXPECT_EQ(outline.rings.size(), 1u);
    EXPECT_NEAR(area(outline), 1, 1e-9);
    EXPECT_TRUE(EvidenceGrid().outline({}).empty());
}

TEST(EvidenceGrid, OutlinesDoNotCross) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> c(-1, 1);
    for (int trial = 0; trial < 30; ++trial) {
        EvidenceGrid grid(Pose::Identity(), 0.025);
        for (int i = 0; i < 12; ++i) {
            const Eigen::Vector2d a(c(random), c(random)), b(c(random), c(random)), d(c(random), c(random));
            grid.add(Outline{{Ring{a, b, d}}});
        }
        OutlineOptions coarse;
        coarse.tolerance_m = 0.1;
        coarse.min_ring_m2 = 0.001;
        EXPECT_FALSE(rings_cross(grid.outline(coarse)));
    }
}

TEST(RingsCross, TellsCrossingFromTouching) {
    const Ring square = rectangle_ring(0, 0, 1, 1);
    EXPECT_FALSE(rings_cross({{square}}));
    EXPECT_FALSE(rings_cross({{square, rectangle_ring(1, 1, 2, 2)}}));
    EXPECT_TRUE(rings_cross({{square, rectangle_ring(0.5, 0.5, 2, 2)}}));
    EXPECT_TRUE(rings_cross({{Ring{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}}));
    EXPECT_FALSE(rings_cross({}));
}

}  // namespace
}  // namespace planemap
