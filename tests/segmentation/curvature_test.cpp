// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/curvature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "segmentation/cell_map.hpp"

namespace planemap::segmentation {
namespace {

constexpr double kBend = 0.6, kGrow = 0.26;  // radians

/// Whether the region of all cells stays.
bool stays(const OwnedMap& owned, CellRegions cell_regions) {
    CellLinks links;
    links.find(owned.map(), 0.006, 1.5);
    CurvedRegions curved(kBend, kGrow);
    curved.remove(owned.map(), links, cell_regions);
    const bool has_cells = cell_regions.regions.at(0).cells > 0;
    EXPECT_EQ(std::count(cell_regions.label_of_cell.begin(), cell_regions.label_of_cell.end(), 1) > 0,
              has_cells);
    return has_cells;
}

/// Tangent planes of a cylinder of this radius whose nearest line is 1.5 m ahead.
OwnedMap cylinder(double radius) {
    return make_map(20, 15, [=](int x, int) {
        const double px = kCell * (x - 10);
        const double turn = std::asin(std::clamp(px * 1.5 / radius, -0.95, 0.95));
        const Eigen::Vector3d normal(std::sin(turn), 0, -std::cos(turn));
        const double d = -normal.dot(Eigen::Vector3d(0, 0, 1.5 + radius) + radius * normal);
        return InverseDepthPlane{-normal.x() / d, -normal.y() / d, -normal.z() / d};
    });
}

int all(int, int) {
    return 1;
}

TEST(CurvedRegionsTest, PlanesStayHoweverTheyLie) {
    for (const double a : {-0.8, 0.0, 0.5}) {
        const OwnedMap owned = make_map(20, 15, [=](int, int) { return InverseDepthPlane{a, 0.1, 0.5}; });
        EXPECT_TRUE(stays(owned, make_regions(owned, all))) << a;
    }
}

TEST(CurvedRegionsTest, ATightCylinderGoesAndAWideOneStays) {
    EXPECT_FALSE(stays(cylinder(0.4), make_regions(cylinder(0.4), all)));
    EXPECT_TRUE(stays(cylinder(20), make_regions(cylinder(20), all)));
}

TEST(CurvedRegionsTest, AFlatPieceOfACurvedSurfaceGoesByItsBorders) {
    const OwnedMap owned = cylinder(0.4);
    const CellRegions strip = make_regions(owned, [](int x, int) { return x >= 9 && x <= 11 ? 1 : 0; });
    EXPECT_FALSE(stays(owned, strip)) << "the surface goes on, turned";
}

TEST(CurvedRegionsTest, RegionsWithoutCellsAndNoRegionsAreNothing) {
    const OwnedMap owned = make_map(20, 15, [](int, int) { return InverseDepthPlane{0, 0, 0.5}; });
    CellRegions none = make_regions(owned, [](int, int) { return 0; });
    CellLinks links;
    links.find(owned.map(), 0.006, 1.5);
    CurvedRegions curved(kBend, kGrow);
    EXPECT_NO_THROW(curved.remove(owned.map(), links, none));
    none.regions.emplace_back();
    EXPECT_NO_THROW(curved.remove(owned.map(), links, none));
}

}  // namespace
}  // namespace planemap::segmentation
