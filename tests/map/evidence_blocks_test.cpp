// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::rectangle_ring;

constexpr double kCell_m = 0.025;

FlatPolygon polygon_of(const Ring& ring) {
    FlatPolygon polygon;
    polygon.assign(Outline{{ring}});
    return polygon;
}

EvidenceGrid grid_of(const Ring& ring, int looks = 1) {
    EvidenceGrid grid(Pose::Identity(), kCell_m);
    grid.add(polygon_of(ring), 0, looks);
    return grid;
}

std::vector<EvidenceBlock> all_of(const EvidenceGrid& grid) {
    std::vector<EvidenceBlock> blocks;
    add_seen_blocks(grid, {-1e9, -1e9}, {1e9, 1e9}, blocks);
    return blocks;
}

int cells_in(const std::vector<EvidenceBlock>& blocks) {
    int cells = 0;
    for (const EvidenceBlock& block : blocks) cells += std::popcount(block.cells);
    return cells;
}

TEST(EvidenceBlocks, HoldEachSeenCellOnceRowAfterRow) {
    // 21 x 9 cells from (-7, -3) on: blocks are cut by all four sides.
    const EvidenceGrid grid = grid_of(rectangle_ring(-7 * kCell_m, -3 * kCell_m, 14 * kCell_m, 6 * kCell_m));
    const std::vector<EvidenceBlock> blocks = all_of(grid);
    EXPECT_EQ(cells_in(blocks), 21 * 9);
    EXPECT_EQ(blocks.size(), 6u * 3u);
    EXPECT_TRUE(std::is_sorted(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) {
        return std::pair(a.middle.y(), a.middle.x()) < std::pair(b.middle.y(), b.middle.x());
    }));
    for (const EvidenceBlock& block : blocks) {
        EXPECT_EQ(block.y % 4, 0);
        EXPECT_NEAR(block.middle.y(), kCell_m * (block.y + 2), 1e-12);
    }
}

TEST(EvidenceBlocks, OutsideOfWhatIsAskedForThereAreNone) {
    const EvidenceGrid grid = grid_of(rectangle_ring(0, 0, 1, 1));
    std::vector<EvidenceBlock> blocks;
    add_seen_blocks(grid, {5, 5}, {6, 6}, blocks);
    add_seen_blocks(grid, {-6, -6}, {-5, -5}, blocks);
    EXPECT_TRUE(blocks.empty());
    add_seen_blocks(grid, {0, 0.5}, {1, 0.52}, blocks);
    EXPECT_EQ(blocks.size(), 10u) << "one row of blocks";
    add_seen_blocks(EvidenceGrid(), {-1, -1}, {1, 1}, blocks);
    EXPECT_EQ(blocks.size(), 10u);
}

TEST(EvidenceBlocks, UnseenOnesAreOfCellsThatNobodySaw) {
    EvidenceGrid grid = grid_of(rectangle_ring(0, 0, 0.5, 1));
    const Bitmap cells = grid.cells_of(polygon_of(rectangle_ring(0.45, 0, 0.6, 1)));
    std::vector<EvidenceBlock> blocks;
    add_unseen_blocks(grid, cells, blocks);
    EXPECT_EQ(cells_in(blocks), 4 * 40) << "0.1 m of the 0.15 m";
    for (const EvidenceBlock& block : blocks) EXPECT_GT(block.middle.x(), 0.5);
}

TEST(EvidenceBlocks, AMissTakesTheirCellsAwayAndNoOthers) {
    EvidenceGrid grid = grid_of(rectangle_ring(0, 0, 1, 1));
    std::vector<EvidenceBlock> blocks = all_of(grid);
    ASSERT_EQ(blocks.size(), 100u);
    EXPECT_EQ(miss(grid, blocks[37], 1), 16);
    EXPECT_EQ(grid.evidence(blocks[37].middle).odds, 0);
    EXPECT_EQ(grid.evidence(blocks[38].middle).odds, 1);
    blocks[5].cells = 0x0001;  // its first cell alone
    EXPECT_EQ(miss(grid, blocks[5], 1), 1);
    EXPECT_EQ(miss_before(grid, blocks[6], 1), 16) << "seen as often before as looked through";
    EXPECT_EQ(miss(grid, blocks[7], EvidenceCells::kMaxOdds * 3), 16);
    EXPECT_EQ(all_of(grid).size(), 99u) << "where odds can fall no further nobody needs to ask";
}

TEST(EvidenceBlocks, AreNearABitmapsCellsUpToWordBorders) {
    // Around the border between two words of a row, at x = 64 cells.
    EvidenceGrid grid = grid_of(rectangle_ring(60 * kCell_m, 0, 68 * kCell_m, 4 * kCell_m));
    const std::vector<EvidenceBlock> blocks = all_of(grid);
    ASSERT_EQ(blocks.size(), 2u);
    for (const int x : {56, 57, 58, 59, 60, 63, 64, 67, 68, 70}) {
        Bitmap cells(0, 0, 2, 4);
        cells.set(x, 1, true);
        for (const int beside : {0, 1, 3}) {
            EXPECT_EQ(is_near(grid, cells, blocks[0], beside), x >= 60 - beside && x < 64 + beside) << x;
            EXPECT_EQ(is_near(grid, cells, blocks[1], beside), x >= 64 - beside && x < 68 + beside) << x;
        }
    }
    Bitmap above(0, 0, 2, 8);
    above.set(61, 6, true);
    EXPECT_FALSE(is_near(grid, above, blocks[0], 2));
    EXPECT_TRUE(is_near(grid, above, blocks[0], 3));
}

TEST(EvidenceBlocks, AreDecidedOnceEnoughLooksSaidTheSame) {
    EvidenceGrid grid = grid_of(rectangle_ring(0, 0, 0.1, 0.1));
    const std::vector<EvidenceBlock> blocks = all_of(grid);
    ASSERT_EQ(blocks.size(), 1u);
    grid.forget_odds();
    EXPECT_TRUE(is_undecided(grid, blocks[0]));
    miss_before(grid, blocks[0], EvidenceCells::kMaxOdds - EvidenceCells::kLeastOdds);
    EXPECT_FALSE(is_undecided(grid, blocks[0]));
}

}  // namespace
}  // namespace planemap::map
