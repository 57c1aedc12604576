// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/mask_octree.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>
#include <set>

#include "octomap/octomap_sizes.hpp"

namespace planemap::octomap {
namespace {

using Cell = std::array<int, 3>;

constexpr std::size_t kHeader = 13;

std::vector<Voxel> random_cells(std::size_t count, int reach, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> at(-reach, reach);
    std::vector<Voxel> cells;
    for (std::size_t i = 0; i < count; ++i) cells.push_back({at(random), at(random), at(random) / 4});
    return cells;
}

/// The cells that the bytes say, read as the format is told.
std::set<Cell> read(const std::string& bytes) {
    const auto byte = [&](std::size_t i) {
        return static_cast<unsigned>(static_cast<unsigned char>(bytes.at(i)));
    };
    Cell low{};
    for (std::size_t k = 0; k < 3; ++k)
        low[k] = static_cast<int>(byte(4 * k) | byte(4 * k + 1) << 8 | byte(4 * k + 2) << 16 |
                                  byte(4 * k + 3) << 24);
    std::vector<Cell> level{{0, 0, 0}};
    std::size_t at = kHeader;
    for (unsigned depth = byte(12); depth > 0; --depth) {
        std::vector<Cell> children;
        for (const Cell& node : level) {
            const unsigned mask = byte(at++);
            for (int i = 0; i < 8; ++i)
                if ((mask >> i & 1) != 0)
                    children.push_back(
                        {2 * node[0] + (i & 1), 2 * node[1] + (i >> 1 & 1), 2 * node[2] + (i >> 2)});
        }
        level = children;
    }
    EXPECT_EQ(at, bytes.size());
    std::set<Cell> cells;
    for (const Cell& c : level) cells.insert({low[0] + c[0], low[1] + c[1], low[2] + c[2]});
    return cells;
}

TEST(MaskOctree, HoldsTheCellsInAByteAnInnerNode) {
    for (const int reach : {1, 5, 40, 1000}) {
        const std::vector<Voxel> cells = random_cells(500, reach, static_cast<std::uint64_t>(reach));
        const std::string bytes = mask_octree(cells);
        std::set<Cell> there;
        Cell low{1 << 20, 1 << 20, 1 << 20}, high{-(1 << 20), -(1 << 20), -(1 << 20)};
        for (const Voxel& c : cells) {
            const Cell cell{c.x, c.y, c.z};
            there.insert(cell);
            for (std::size_t k = 0; k < 3; ++k)
                low[k] = std::min(low[k], cell[k]), high[k] = std::max(high[k], cell[k]);
        }
        EXPECT_EQ(read(bytes), there);
        // Its inner nodes, by sets: what distinct cells become when they are halved again and again.
        std::size_t nodes = 0;
        std::set<Cell> level;
        for (const Cell& c : there) level.insert({c[0] - low[0], c[1] - low[1], c[2] - low[2]});
        int edge = 1;
        while (edge <= std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]})) {
            edge *= 2;
            std::set<Cell> parents;
            for (const Cell& c : level) parents.insert({c[0] / 2, c[1] / 2, c[2] / 2});
            nodes += parents.size();
            level = parents;
        }
        EXPECT_EQ(bytes.size(), kHeader + nodes);
    }
}

TEST(MaskOctree, NothingOrOneCellIsItsHeader) {
    EXPECT_EQ(mask_octree({}).size(), kHeader);
    EXPECT_EQ(mask_octree({{3, -4, 5}}).size(), kHeader);
    EXPECT_EQ(read(mask_octree({{3, -4, 5}})), (std::set<Cell>{{3, -4, 5}}));
    EXPECT_EQ(mask_octree({{3, -4, 5}, {3, -4, 5}}).size(), kHeader);
}

TEST(MaskOctree, OrderDoesNotCount) {
    std::vector<Voxel> cells = random_cells(300, 30, 9);
    const std::string bytes = mask_octree(cells);
    std::reverse(cells.begin(), cells.end());
    EXPECT_EQ(mask_octree(cells), bytes);
}

TEST(MaskOctree, CellsAndTreesOfCentresAreTheSame) {
    for (const double edge : {0.05, 0.02, 0.1}) {
        std::vector<Eigen::Vector3d> centres;
        for (const Voxel& c : random_cells(400, 60, 3))
            centres.push_back(edge * (Eigen::Vector3d(c.x, c.y, c.z) + Eigen::Vector3d::Constant(0.5)));
        const auto as_set = [](const std::vector<Voxel>& cells) {
            std::set<Cell> set;
            for (const Voxel& c : cells) set.insert({c.x, c.y, c.z});
            return set;
        };
        const std::unique_ptr<::octomap::OcTree> tree = tree_of(centres, edge);
        EXPECT_EQ(as_set(cells_at(occupied_voxels_of(*tree), edge)), as_set(cells_at(centres, edge)));
        EXPECT_EQ(bt_occupied_of(*tree), bt_of(*tree)) << "nothing is free";
    }
}

}  // namespace
}  // namespace planemap::octomap
