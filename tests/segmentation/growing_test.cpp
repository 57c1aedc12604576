// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/growing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "segmentation/cell_map.hpp"

namespace planemap::segmentation {
namespace {

std::size_t regions_of(const OwnedMap& owned, double min_pixels = 5 * kPixels) {
    RegionGrower grower{CellOptions{}};
    grower.grow(owned.map(), min_pixels);
    EXPECT_EQ(grower.label_of_cell().size(), owned.cells.size());
    for (const std::uint16_t label : grower.label_of_cell()) EXPECT_LE(label, grower.planes().size());
    return grower.planes().size();
}

TEST(GrowingTest, OnePlaneIsOneRegion) {
    EXPECT_EQ(regions_of(make_map(20, 15, [](int, int) { return InverseDepthPlane{0.2, 0.1, 0.5}; })), 1u);
}

TEST(GrowingTest, RecoversThePlane) {
    RegionGrower grower{CellOptions{}};
    const InverseDepthPlane plane{0.2, -0.1, 0.5};
    const OwnedMap owned = make_map(20, 15, [&](int, int) { return plane; });
    grower.grow(owned.map(), 100);
    ASSERT_EQ(grower.planes().size(), 1u);
    EXPECT_NEAR(grower.planes()[0].a, plane.a, 1e-6);
    EXPECT_NEAR(grower.planes()[0].b, plane.b, 1e-6);
    EXPECT_NEAR(grower.planes()[0].c, plane.c, 1e-6);
}

TEST(GrowingTest, StepSplits) {
    const auto step = [](int x, int) { return InverseDepthPlane{0, 0, 1 / (x < 10 ? 1.5 : 1.53)}; };
    EXPECT_EQ(regions_of(make_map(20, 15, step)), 2u);
}

TEST(GrowingTest, CreaseSplits) {
    const auto crease = [](int x, int) { return InverseDepthPlane{x < 10 ? 0.5 : -0.5, 0, 0.6}; };
    EXPECT_EQ(regions_of(make_map(20, 15, crease)), 2u);
}

TEST(GrowingTest, ThinGapIsBridged) {
    const auto gap = [](int x, int) {
        return x == 10 ? InverseDepthPlane{} : InverseDepthPlane{0.1, 0, 0.5};
    };
    EXPECT_EQ(regions_of(make_map(20, 15, gap)), 1u);
}

TEST(GrowingTest, CylinderIsDropped) {
    // Tangent planes of a cylinder of 0.4 m at 1.5 m.
    const auto tangent = [](int x, int) {
        const double px = kCell * (x - 10), turn = std::asin(std::clamp(px * 1.5 / 0.4, -0.95, 0.95));
        const Eigen::Vector3d normal(std::sin(turn), 0, -std::cos(turn));
        const Eigen::Vector3d point = Eigen::Vector3d(0, 0, 1.9) + 0.4 * normal;
        const double d = -normal.dot(point);
        return InverseDepthPlane{-normal.x() / d, -normal.y() / d, -normal.z() / d};
    };
    EXPECT_EQ(regions_of(make_map(20, 15, tangent)), 0u);
}

TEST(GrowingTest, SmallRegionsAreDropped) {
    const auto patch = [](int x, int y) {
        return x < 3 && y < 3 ? InverseDepthPlane{0, 0, 0.5} : InverseDepthPlane{};
    };
    EXPECT_EQ(regions_of(make_map(20, 15, patch), 9 * kPixels), 1u);
    EXPECT_EQ(regions_of(make_map(20, 15, patch), 30 * kPixels), 0u);
}

TEST(GrowingTest, NeitherNoiseNorAngleNorPixels) {
    // Limits of zero make points of a seed 0 / 0; sums of nothing determine no plane.
    for (const float nan_or_zero : {0.0f, std::nanf("")}) {
        OwnedMap owned = make_map(20, 15, [](int x, int) {
            return InverseDepthPlane{0.2, x < 10 ? 0.1 : 0.4, 0.5};
        });
        for (Cell& cell : owned.cells) cell.sigma = nan_or_zero, cell.cos_limit = 1;
        regions_of(owned, 0);
        for (Cell& cell : owned.cells) cell.sigma = 0.002f, cell.mse = std::nanf("");
        regions_of(owned, 0);
        for (Cell& cell : owned.cells) cell.cos_limit = 1.0001f, cell.mse = 0;
        regions_of(owned, 0);
        owned = make_map(20, 15, [](int, int) { return InverseDepthPlane{0.2, 0.1, 0.5}; });
        for (Cell& cell : owned.cells) cell.pixels = nan_or_zero;
        EXPECT_EQ(regions_of(owned, 0), 0u);
    }
}

TEST(GrowingTest, MoreRegionsThanLabels) {
    // A checkerboard of planes 10 cm apart: a region a cell, if so small ones are asked for, but for some
    // pairs that merge into a steep plane.
    const auto board = [](int x, int y) {
        return InverseDepthPlane{0, 0, 1 / ((x + y) % 2 == 0 ? 1.5 : 1.6)};
    };
    const std::size_t regions = regions_of(make_map(100, 60, board), 0);
    EXPECT_GT(regions, 3500u);
    EXPECT_LE(regions, 4096u);
}

TEST(GrowingTest, NothingPlanarOrNoCells) {
    EXPECT_EQ(regions_of(make_map(20, 15, [](int, int) { return InverseDepthPlane{}; })), 0u);
    EXPECT_EQ(regions_of(make_map(1, 1, [](int, int) { return InverseDepthPlane{0, 0, 0.5}; }), 0), 1u);
    EXPECT_EQ(regions_of(OwnedMap{}), 0u);
}

}  // namespace
}  // namespace planemap::segmentation
