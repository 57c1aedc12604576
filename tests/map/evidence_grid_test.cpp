// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_grid.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/geometry/crossing.hpp"
#include "core/scene.hpp"
#include "map/estimates.hpp"
#include "map/evidence_blocks.hpp"
#include "map/evidence_shape.hpp"

namespace planemap::map {
namespace {

using scene::rectangle_ring;

int add(EvidenceGrid& grid, const Outline& outline, int strength = 0) {
    FlatPolygon polygon;
    polygon.assign(outline);
    return grid.add(polygon, strength);
}

template <typename IsMissed>
int miss(EvidenceGrid& grid, int looks, const IsMissed& is_missed) {
    std::vector<EvidenceBlock> blocks;
    add_seen_blocks(grid, {-1e9, -1e9}, {1e9, 1e9}, blocks);
    int lost = 0;
    for (const EvidenceBlock& block : blocks)
        if (is_missed(block.middle)) lost += miss(grid, block, looks);
    return lost;
}

OutlineOptions every_cell() {
    OutlineOptions options = samples::kOutline;
    options.min_ring_m2 = 0;
    options.tolerance_m = 0;
    return options;
}

TEST(EvidenceGrid, HasTheAreaOfWhatWasAdded) {
    EvidenceGrid grid(Pose::Identity(), 0.025);
    const int fresh =
        add(grid, Outline{{rectangle_ring(-1, -0.5, 1, 0.5), rectangle_ring(-0.2, -0.2, 0.2, 0.2)}});
    EXPECT_EQ(fresh, 2944) << "(2 - 0.16) / 0.025^2";
    const Outline outline = outline_of(grid, samples::kOutline);
    EXPECT_EQ(outline.rings.size(), 2u);
    EXPECT_NEAR(area(outline), 2 - 0.16, 0.03);
    EXPECT_FALSE(contains(outline, {0, 0}));
    EXPECT_TRUE(contains(outline, {0.5, 0.3}));
}

TEST(EvidenceGrid, FillsTheCellsWhoseCentreIsInside) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> c(-4.4, 4.4);
    for (int trial = 0; trial < 20; ++trial) {
        Outline outline{{Ring{}}};
        for (int i = 0; i < 9; ++i) outline.rings[0].emplace_back(c(random), c(random));
        EvidenceGrid grid(Pose::Identity(), 0.05);
        add(grid, outline);
        for (int y = 0; y < 180; ++y) {
            for (int x = 0; x < 180; ++x) {
                const Eigen::Vector2d centre(0.05 * (x - 89.5), 0.05 * (y - 89.5));
                ASSERT_EQ(grid.evidence(centre).support, contains(outline, centre) ? 1 : 0);
            }
        }
    }
}

TEST(EvidenceGrid, GrowsAndCounts) {
    EvidenceGrid grid(Pose::Identity(), 0.05);
    add(grid, Outline{{rectangle_ring(0, 0, 1, 1)}});
    add(grid, Outline{{rectangle_ring(0.5, 0, 5, 1)}}, 1);
    EXPECT_EQ(add(grid, Outline{{rectangle_ring(-2, -2, -1, -1)}}, 2), 400);
    const auto hits = [&](double x, double y) { return grid.evidence({x, y}).support; };
    EXPECT_EQ(hits(0.2, 0.5), 1);
    EXPECT_EQ(hits(0.7, 0.5), 3);
    EXPECT_EQ(hits(4.7, 0.5), 2);
    EXPECT_EQ(hits(-1.5, -1.5), 4);
    EXPECT_EQ(hits(-0.5, -0.5), 0);
    EXPECT_EQ(hits(1e9, -1e9), 0);
    OutlineOptions twice = samples::kOutline;
    twice.min_support = 3;
    EXPECT_NEAR(area(outline_of(grid, twice)), 0.5 + 1, 1e-9);
    EXPECT_NEAR(area(outline_of(grid, samples::kOutline)), 6, 1e-9);
    for (int i = 0; i < 300; ++i) add(grid, Outline{{rectangle_ring(0, 0, 1, 1)}}, i % 3);
    EXPECT_EQ(hits(0.2, 0.5), EvidenceCells::kMaxSupport);
    EXPECT_EQ(hits(4.7, 0.5), 2);
}

TEST(EvidenceGrid, AddsAnotherGridInAnotherFrame) {
    const Outline shape{{rectangle_ring(-1, -0.5, 1, 0.5), rectangle_ring(0.1, -0.2, 0.5, 0.2)}};
    EvidenceGrid other(scene::facing({0.3, 0.2, 0}, {0, 0, 1}, {0.8, 0.6, 0}), 0.025);
    add(other, shape, 1);
    EvidenceGrid grid(Pose::Identity(), 0.025);
    grid.add(other);
    EXPECT_NEAR(area(outline_of(grid, samples::kOutline)), area(shape), 0.06);
    const Eigen::Vector3d hole = other.world_from_grid() * Eigen::Vector3d(0.3, 0, 0);
    const Eigen::Vector3d solid = other.world_from_grid() * Eigen::Vector3d(-0.3, 0, 0);
    EXPECT_EQ(grid.evidence(hole.head<2>()).support, 0);
    EXPECT_EQ(grid.evidence(solid.head<2>()).support, 2);
    grid.add(EvidenceGrid(Pose::Identity(), 0.025));
    EXPECT_NEAR(area(outline_of(grid, samples::kOutline)), area(shape), 0.06);
}

TEST(EvidenceGrid, LeavesOutSmallPartsAndHoles) {
    EvidenceGrid grid(Pose::Identity(), 0.025);
    add(grid, Outline{{rectangle_ring(0, 0, 1, 1), rectangle_ring(0.4, 0.4, 0.475, 0.475),
                       rectangle_ring(2, 0, 2.075, 0.075)}});
    const Outline outline = outline_of(grid, samples::kOutline);
    EXPECT_EQ(outline.rings.size(), 1u);
    EXPECT_NEAR(area(outline), 1, 1e-9);
    EXPECT_TRUE(outline_of(EvidenceGrid(), samples::kOutline).empty());
}

TEST(EvidenceGrid, SliversNeedSupport) {
    // A plate with a strip of 5 cm beside it that sticks out.
    const Outline plate{{rectangle_ring(0, 0, 1, 1)}}, strip{{rectangle_ring(1, 0.5, 2, 0.55)}};
    EvidenceGrid grid(Pose::Identity(), 0.025);
    add(grid, plate);
    add(grid, strip);
    EXPECT_NEAR(area(outline_of(grid, every_cell())), 1, 1e-9) << "seen once, from afar";
    for (int i = 0; i < 3; ++i) add(grid, strip, 2);
    EXPECT_NEAR(area(outline_of(grid, every_cell())), 1.05, 1e-9) << "seen again and again";
}

TEST(EvidenceGrid, WhatIsMissedAsOftenAsSeenGoesAndComesBack) {
    const Outline plate{{rectangle_ring(0, 0, 2, 1)}};
    EvidenceGrid grid(Pose::Identity(), 0.025);
    EXPECT_EQ(add(grid, plate), 3200);
    const auto left = [](const Eigen::Vector2d& p) { return p.x() < 1; };
    EXPECT_EQ(miss(grid, 1, left), 1600) << "seen once, looked through once";
    EXPECT_NEAR(area(outline_of(grid, samples::kOutline)), 1, 1e-9);
    EXPECT_EQ(miss(grid, 1, left), 0) << "it is gone";
    EXPECT_EQ(grid.evidence({0.5, 0.5}).odds, -1);
    EXPECT_EQ(grid.evidence({1.5, 0.5}).odds, 1);
    EXPECT_EQ(add(grid, plate), 0);
    EXPECT_EQ(add(grid, plate), 1600) << "more often seen than looked through";
    for (int i = 0; i < 30; ++i) add(grid, plate, 2);
    EXPECT_EQ(miss(grid, EvidenceCells::kMaxOdds - 1, left), 0);
    EXPECT_EQ(miss(grid, 1, left), 1600) << "whatever went before";
}

TEST(EvidenceGrid, MissesCountOnlyWhereTheyAre) {
    EvidenceGrid part(Pose::Identity(), 0.025);
    add(part, Outline{{rectangle_ring(-3, -1, 3, 1)}});
    std::vector<EvidenceBlock> lower, beyond;
    add_seen_blocks(part, {-10, -10}, {10, -0.1}, lower);
    for (const EvidenceBlock& block : lower) miss(part, block, 1);
    EXPECT_NEAR(area(outline_of(part, samples::kOutline)), 6, 0.7) << "the upper half is left";
    EXPECT_FALSE(contains(outline_of(part, samples::kOutline), {0, -0.5}));
    add_seen_blocks(part, {5, 5}, {6, 6}, beyond);
    EXPECT_TRUE(beyond.empty());
}

TEST(EvidenceGrid, TellsWhatWasNeverSeenBefore) {
    EvidenceGrid grid(Pose::Identity(), 0.025);
    std::vector<EvidenceBlock> fresh;
    FlatPolygon polygon;
    polygon.assign(Outline{{rectangle_ring(0, 0, 1, 1)}});
    grid.add(polygon, 0, 1, &fresh);
    EXPECT_EQ(fresh.size(), 100u);
    fresh.clear();
    polygon.assign(Outline{{rectangle_ring(0.05, 0, 1.05, 1)}});
    grid.add(polygon, 0, 1, &fresh);
    EXPECT_EQ(fresh.size(), 10u);
    int lost = 0;
    for (const EvidenceBlock& block : fresh) lost += miss_before(grid, block, 1);
    EXPECT_EQ(lost, 80) << "only what is fresh";
    fresh.clear();
    grid.add(polygon, 0, 1, &fresh);
    EXPECT_TRUE(fresh.empty());
}

TEST(EvidenceGrid, WhatWasBeforeCountsWhereLooksHaveNotDecided) {
    const Outline plate{{rectangle_ring(0, 0, 1, 1)}}, wide{{rectangle_ring(0, 0, 2, 1)}};
    FlatPolygon polygon;
    for (const int looks : {1, 4, 5}) {
        const bool have_decided = looks == EvidenceCells::kMaxOdds;
        EvidenceGrid before(Pose::Identity(), 0.025);
        polygon.assign(plate);
        before.add(polygon, 2, EvidenceCells::kMaxOdds);
        EvidenceGrid grid = before;
        grid.forget_odds();
        polygon.assign(wide);
        const Bitmap cells = grid.cells_of(polygon);
        grid.add_support(cells, 0);
        std::vector<EvidenceBlock> blocks;
        add_seen_blocks(grid, {-1, -1}, {3, 3}, blocks);
        for (const EvidenceBlock& block : blocks) miss_before(grid, block, looks);
        grid.settle_on(before);
        EXPECT_EQ(grid.evidence({0.5, 0.5}).odds, have_decided ? EvidenceCells::kLeastOdds : 5 - looks);
        EXPECT_EQ(grid.evidence({1.5, 0.5}).odds, have_decided ? EvidenceCells::kLeastOdds : -looks);
    }
}

TEST(EvidenceGrid, OutlinesDoNotCross) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> c(-1, 1);
    for (int trial = 0; trial < 30; ++trial) {
        EvidenceGrid grid(Pose::Identity(), 0.025);
        for (int i = 0; i < 12; ++i) {
            const Eigen::Vector2d a(c(random), c(random)), b(c(random), c(random)), d(c(random), c(random));
            add(grid, Outline{{Ring{a, b, d}}});
        }
        OutlineOptions coarse = samples::kOutline;
        coarse.tolerance_m = 0.1;
        coarse.min_ring_m2 = 0.001;
        EXPECT_FALSE(rings_cross(outline_of(grid, coarse)));
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
}  // namespace planemap::map
