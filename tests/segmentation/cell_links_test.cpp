// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_links.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "segmentation/cell_map.hpp"

namespace planemap::segmentation {
namespace {

constexpr int kColumns = 8, kRows = 6;

CellLinks links_of(const OwnedMap& owned) {
    CellLinks links;
    links.find(owned.map(), 0.006, 1.5);
    return links;
}

InverseDepthPlane slanted(int, int) {
    return {0.2, -0.1, 0.5};
}

TEST(CellLinksTest, ThePlanesCellsAreAllLinkedInsideTheImage) {
    const OwnedMap owned = make_map(kColumns, kRows, slanted);
    const CellLinks links = links_of(owned);
    for (int y = 0, i = 0; y < kRows; ++y) {
        for (int x = 0; x < kColumns; ++x, ++i) {
            EXPECT_EQ(links.linked(i, 0), x + 1 < kColumns);
            EXPECT_EQ(links.linked(i, 1), y + 1 < kRows);
            EXPECT_EQ(links.linked(i, 2), x > 0);
            EXPECT_EQ(links.linked(i, 3), y > 0);
            EXPECT_NEAR(static_cast<double>(links.turn(i)), 0, 1e-5);
        }
    }
}

TEST(CellLinksTest, LinksAreMutualAndEndAtStepsAndHoles) {
    const OwnedMap owned = make_map(kColumns, kRows, [](int x, int y) {
        if (x == 2 && y == 2) return InverseDepthPlane{};
        return InverseDepthPlane{0, 0, x < 4 ? 1 / 1.5 : 1 / 1.6};
    });
    const CellLinks links = links_of(owned);
    const std::array<int, 4> steps = owned.map().neighbour_steps();
    for (int i = 0; i < kColumns * kRows; ++i) {
        for (int k = 0; k < 4; ++k)
            if (links.linked(i, k)) {
                EXPECT_TRUE(links.linked(i + steps[static_cast<std::size_t>(k)], (k + 2) % 4));
            }
    }
    for (int y = 0; y < kRows; ++y) EXPECT_FALSE(links.linked(y * kColumns + 3, 0)) << "the step";
    EXPECT_EQ(links.count(2 * kColumns + 2), 0) << "the hole";
    EXPECT_EQ(links.count(2 * kColumns + 1), 3) << "beside it";
}

TEST(CellLinksTest, ACreaseIsLinkedAndItsTurnIsKnown) {
    const CellLinks links = links_of(make_map(kColumns, kRows, [](int x, int) {
        return InverseDepthPlane{x < kColumns / 2 ? 0.05 : -0.05, 0, 0.6};
    }));
    const int beside = 2 * kColumns + kColumns / 2;
    EXPECT_TRUE(links.linked(beside - 1, 0));
    EXPECT_NEAR(static_cast<double>(links.turn(beside)), 1 - std::cos(2 * std::atan(0.05 / 0.6)), 1e-4);
    EXPECT_NEAR(static_cast<double>(links.turn(beside + 2)), 0, 1e-5);
}

TEST(CellLinksTest, NoCellsHaveNoLinks) {
    EXPECT_NO_THROW(links_of(OwnedMap{}));
    const CellLinks links = links_of(make_map(3, 3, [](int, int) { return InverseDepthPlane{}; }));
    for (int i = 0; i < 9; ++i) EXPECT_EQ(links.count(i), 0);
}

TEST(SeedOrderTest, EveryPlanarCellOnceTheInnermostFirst) {
    const OwnedMap owned =
        make_map(kColumns, kRows, [](int x, int y) { return x == 7 ? InverseDepthPlane{} : slanted(x, y); });
    SeedOrder order;
    order.rank(owned.map(), links_of(owned));
    const std::set<int> seeds(order.seeds().begin(), order.seeds().end());
    EXPECT_EQ(order.seeds().size(), 7u * kRows);
    EXPECT_EQ(seeds.size(), order.seeds().size());
    const int first = order.seeds().front(), last = order.seeds().back();
    EXPECT_GT(first % kColumns, 0);
    EXPECT_GT(first / kColumns, 0);
    EXPECT_TRUE(last == 0 || last == 6 || last == 5 * kColumns || last == 5 * kColumns + 6) << "a corner";
    order.rank(OwnedMap{}.map(), links_of(OwnedMap{}));
    EXPECT_TRUE(order.seeds().empty());
}

}  // namespace
}  // namespace planemap::segmentation
