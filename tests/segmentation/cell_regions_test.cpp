// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_regions.hpp"

#include <gtest/gtest.h>

#include "segmentation/cell_map.hpp"

namespace planemap::segmentation {
namespace {

/// Two halves: a wall at 2 m on the left, one at 2.5 m on the right.
OwnedMap two_walls() {
    return make_map(8, 4, [](int x, int) { return InverseDepthPlane{0, 0, x < 4 ? 0.5 : 0.4}; });
}

TEST(CellRegions, ARemovedRegionLeavesItsCellsToNobody) {
    const OwnedMap owned = two_walls();
    CellRegions regions = make_regions(owned, [](int x, int) { return x < 4 ? 1 : 2; });
    regions.remove(1);
    for (std::size_t i = 0; i < owned.cells.size(); ++i)
        EXPECT_EQ(regions.label_of_cell[i], i % 8 < 4 ? 0 : 2) << i;
    EXPECT_EQ(regions.at(1).cells, 0);
    EXPECT_EQ(regions.at(2).cells, 16);
}

TEST(Target, AcceptsTheCellsOfItsOwnPlaneAlone) {
    const OwnedMap owned = two_walls();
    std::vector<Target> targets;
    make_targets(make_regions(owned, [](int x, int) { return x < 4 ? 1 : 2; }), targets);
    ASSERT_EQ(targets.size(), 2u);
    for (std::size_t i = 0; i < owned.cells.size(); ++i) {
        const std::size_t own = i % 8 < 4 ? 0 : 1;
        EXPECT_TRUE(targets[own].accepts(owned.cells[i])) << i;
        EXPECT_FALSE(targets[1 - own].accepts(owned.cells[i])) << i;
        EXPECT_LT(targets[own].mse_to(owned.cells[i]), targets[1 - own].mse_to(owned.cells[i])) << i;
    }
}

TEST(Target, RefusesACellThatIsTurnedBeyondItsLimit) {
    const OwnedMap owned = two_walls();
    std::vector<Target> targets;
    make_targets(make_regions(owned, [](int x, int) { return x < 4 ? 1 : 2; }), targets);
    Cell turned = owned.cells[0];  // cells accept up to 0.3 rad
    turned.nx = std::sin(0.25f);
    turned.nz = std::copysign(std::cos(0.25f), turned.nz);
    EXPECT_TRUE(targets[0].accepts(turned));
    turned.nx = std::sin(0.35f);
    turned.nz = std::copysign(std::cos(0.35f), turned.nz);
    EXPECT_FALSE(targets[0].accepts(turned));
}

TEST(CellMap, StepsLeadToTheFourNeighbours) {
    const OwnedMap owned = two_walls();
    const std::array<int, 4> steps = owned.map().neighbour_steps();
    EXPECT_EQ(steps, (std::array<int, 4>{1, 8, -1, -8}));
}

}  // namespace
}  // namespace planemap::segmentation
