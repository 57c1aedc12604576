// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_blocks.hpp"

#include <gtest/gtest.h>

#include <random>

namespace planemap::octomap {
namespace {

::octomap::OcTreeKey key(int x, int y, int z) {
    return {static_cast<::octomap::key_type>(x), static_cast<::octomap::key_type>(y),
            static_cast<::octomap::key_type>(z)};
}

/// Cells from 32700 up: single ones, and a cube of 128 that is all free, so that leaves larger than a block
/// are in the tree.
std::unique_ptr<::octomap::OcTree> random_tree(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> at(32700, 32950), state(0, 2);
    auto tree = std::make_unique<::octomap::OcTree>(0.05);
    for (int i = 0; i < 20000; ++i)
        tree->updateNode(key(at(random), at(random) / 2, at(random) / 3), state(random) == 0, true);
    for (int x = 0; x < 128; ++x) {
        for (int y = 0; y < 128; ++y) {
            for (int z = 0; z < 128; ++z)
                tree->setNodeValue(key(32704 + x, 32704 + y, 32704 + z), -0.4F, true);
        }
    }
    bring_up_to_date(*tree);
    return tree;
}

/// What a tree says of a cell: its log-odds, or no value.
std::optional<float> value(const ::octomap::OcTree& tree, const ::octomap::OcTreeKey& k) {
    const auto* node = tree.getRoot() != nullptr ? tree.search(k) : nullptr;
    return node != nullptr ? std::optional(node->getLogOdds()) : std::nullopt;
}

/// The number of nodes that there really are.
std::size_t walked(const ::octomap::OcTree& tree) {
    std::size_t nodes = 0;
    for (auto node = tree.begin_tree(), end = tree.end_tree(); node != end; ++node) ++nodes;
    return nodes;
}

TEST(TreeBlocks, ComposedTakesEachCellFromTheTreeItIsToComeFrom) {
    const auto outside = random_tree(1), inside = random_tree(2);
    BlockSet blocks;
    for (const auto& [x, y, z] : {std::tuple(0, 0, 0), {1, 2, 0}, {2, 2, 2}, {500, 500, 500}, {-22, 3, 1}})
        blocks.insert({1022 + x, 1022 + y, 1022 + z});
    for (const ::octomap::OcTree* from :
         std::initializer_list<const ::octomap::OcTree*>{inside.get(), nullptr}) {
        const auto tree = composed(*outside, from, blocks);
        EXPECT_EQ(tree->size(), walked(*tree));
        std::mt19937_64 random(3);
        std::uniform_int_distribution<int> at(32690, 32960);
        int replaced = 0;
        for (int i = 0; i < 20000; ++i) {
            const Voxel cell{at(random), at(random), at(random)};
            const auto k = key(cell.x, cell.y, cell.z);
            const bool in_block = blocks.contains(block_of(cell));
            replaced += in_block;
            const ::octomap::OcTree* source = in_block ? from : outside.get();
            ASSERT_EQ(value(*tree, k), source != nullptr ? value(*source, k) : std::nullopt);
        }
        EXPECT_GT(replaced, 20);
    }
}

TEST(TreeBlocks, WithoutBlocksComposedIsACopyAndWithAllItIsEmpty) {
    const auto tree = random_tree(1);
    auto copy = composed(*tree, nullptr, {});
    bring_up_to_date(*copy);
    EXPECT_TRUE(*copy == *tree);
    BlockSet all;
    for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf) {
        const ::octomap::OcTreeKey k = leaf.getIndexKey();
        const int n = 1 << (tree->getTreeDepth() - leaf.getDepth());
        for (int i = 0; i < n; i += 32) {
            for (int j = 0; j < n; j += 32) {
                for (int l = 0; l < n; l += 32) all.insert(block_of({k[0] + i, k[1] + j, k[2] + l}));
            }
        }
    }
    const auto empty = composed(*tree, nullptr, all);
    EXPECT_EQ(empty->size(), 0u);
    EXPECT_EQ(empty->getRoot(), nullptr);
    const auto taken = composed(::octomap::OcTree(0.05), tree.get(), all);
    EXPECT_EQ(taken->size(), walked(*taken));
    bring_up_to_date(*taken);
    EXPECT_TRUE(*taken == *tree);
}

TEST(TreeBlocks, BringUpToDateDoesWhatOctoMapsOwnDo) {
    std::mt19937_64 random(7);
    std::uniform_int_distribution<int> at(0, 15), state(0, 3);
    ::octomap::OcTree ours(0.1), own(0.1);
    for (int round = 0; round < 5; ++round) {
        for (int i = 0; i < 12000; ++i) {
            const auto k = key(32760 + at(random), 32760 + at(random), 32760 + at(random));
            const bool occupied = state(random) == 0;
            ours.updateNode(k, occupied, true);
            own.updateNode(k, occupied, true);
        }
        bring_up_to_date(ours);
        own.updateInnerOccupancy();
        own.prune();
        ASSERT_TRUE(ours == own);
        ASSERT_EQ(ours.size(), own.size());
        ASSERT_EQ(ours.size(), walked(ours));
    }
}

}  // namespace
}  // namespace planemap::octomap
