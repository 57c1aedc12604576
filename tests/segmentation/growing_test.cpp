// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/growing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace planemap::segmentation {
namespace {

constexpr double kCell = 0.02;  // side, normalised coordinates
constexpr double kPixels = 100;

/// A map with its cells.
struct OwnedMap {
    std::vector<Cell> cells;
    int columns = 0, rows = 0;

    CellMap map() const { return {columns, rows, kCell, DepthNoise{}, cells}; }
};

/// A map whose cell (column, row) lies exactly on the plane that `plane_of` names; one with steepness 0 is
/// not planar.
OwnedMap make_map(int columns, int rows, const std::function<InverseDepthPlane(int, int)>& plane_of) {
    OwnedMap owned;
    owned.columns = columns;
    owned.rows = rows;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            Cell& cell = owned.cells.emplace_back();
            PointSums sums;
            const InverseDepthPlane plane = plane_of(x, y);
            if (plane.steepness() == 0) continue;
            for (const double dx : {-0.3, 0.3}) {
                for (const double dy : {-0.3, 0.3}) {
                    const double px = kCell * (x - 0.5 * columns + dx), py = kCell * (y - 0.5 * rows + dy);
                    const double Z = 1 / plane.at(px, py), X = px * Z, Y = py * Z, k = kPixels / 4;
                    sums.add(k, {1, X, Y, Z, X * X, X * Y, X * Z, Y * Y, Y * Z, Z * Z});
                }
            }
            const InverseDepthFit fit = sums.fit();
            const Eigen::Vector3f normal = -fit.plane.plane().normal.cast<float>();
            cell.x = static_cast<float>(fit.x);
            cell.y = static_cast<float>(fit.y);
            cell.w = static_cast<float>(fit.w);
            cell.sigma = static_cast<float>(DepthNoise{}.sigma(1 / fit.w));
            cell.reach = std::max(0.01f, 1.5f * cell.sigma) * cell.w;
            cell.nx = normal.x();
            cell.ny = normal.y();
            cell.nz = normal.z();
            cell.cos_limit = std::cos(0.3f);
            cell.a = static_cast<float>(fit.plane.a);
            cell.b = static_cast<float>(fit.plane.b);
            cell.xx = static_cast<float>(fit.xx);
            cell.yy = static_cast<float>(fit.yy);
            cell.pixels = static_cast<float>(kPixels);
            cell.per_steepness = static_cast<float>(1 / fit.plane.steepness());
        }
    }
    return owned;
}

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
