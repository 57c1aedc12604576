// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/growing.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace planemap {
namespace {

constexpr double kCell = 0.02;  // side, normalised coordinates
constexpr double kPixels = 100;

/// A map whose cell (column, row) lies exactly on the plane that `plane_of` names; one with steepness 0 is
/// not planar.
CellMap make_map(int columns, int rows, const std::function<InverseDepthPlane(int, int)>& plane_of) {
    CellMap map;
    map.columns = columns;
    map.rows = rows;
    map.cell_x = kCell;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            Cell& cell = map.cells.emplace_back();
            const InverseDepthPlane plane = plane_of(x, y);
            if (plane.steepness() == 0) continue;
            InverseDepthSums sums;
            for (const double dx : {-0.3, 0.3}) {
                for (const double dy : {-0.3, 0.3}) {
                    const double px = kCell * (x - 0.5 * columns + dx), py = kCell * (y - 0.5 * rows + dy);
                    const double w = plane.at(px, py);
                    sums += {1, px, py, px * px, px * py, py * py, w, px * w, py * w, w * w};
                }
            }
            cell.fit = sums.fit();
            cell.pixels = kPixels;
            cell.z = 1 / cell.fit.w;
            cell.sigma = map.noise.sigma(cell.z);
            const double sigma = cell.sigma / (cell.z * cell.z);
            cell.sums = kPixels / 4 / (sigma * sigma) * sums;
            cell.angle_error = 0.05;
            cell.planar = true;
        }
    }
    return map;
}

std::size_t regions_of(const CellMap& map, double min_pixels = 5 * kPixels) {
    RegionGrower grower{CellOptions{}};
    grower.grow(map, min_pixels);
    EXPECT_EQ(grower.label_of_cell().size(), map.cells.size());
    for (const std::uint16_t label : grower.label_of_cell()) EXPECT_LE(label, grower.planes().size());
    return grower.planes().size();
}

TEST(GrowingTest, OnePlaneIsOneRegion) {
    EXPECT_EQ(regions_of(make_map(20, 15, [](int, int) { return InverseDepthPlane{0.2, 0.1, 0.5}; })), 1u);
}

TEST(GrowingTest, RecoversThePlane) {
    RegionGrower grower{CellOptions{}};
    const InverseDepthPlane plane{0.2, -0.1, 0.5};
    grower.grow(make_map(20, 15, [&](int, int) { return plane; }), 100);
    ASSERT_EQ(grower.planes().size(), 1u);
    EXPECT_NEAR(grower.planes()[0].a, plane.a, 1e-9);
    EXPECT_NEAR(grower.planes()[0].b, plane.b, 1e-9);
    EXPECT_NEAR(grower.planes()[0].c, plane.c, 1e-9);
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

TEST(GrowingTest, NothingPlanarOrNoCells) {
    EXPECT_EQ(regions_of(make_map(20, 15, [](int, int) { return InverseDepthPlane{}; })), 0u);
    EXPECT_EQ(regions_of(make_map(1, 1, [](int, int) { return InverseDepthPlane{0, 0, 0.5}; }), 0), 1u);
    EXPECT_EQ(regions_of(CellMap{}), 0u);
}

}  // namespace
}  // namespace planemap
