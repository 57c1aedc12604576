// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_update.hpp"

#include <gtest/gtest.h>

#include <random>

#include "octomap/octomap_sizes.hpp"
#include "octomap/tree_blocks.hpp"
#include "octomap/voxel_set.hpp"

namespace planemap::octomap {
namespace {

constexpr std::int32_t kMiddle = 1 << 15;  // OctoMap's key of the origin

/// Cells about the middle in the same blocks in both forms.
struct Scan {
    BlockTable<std::array<BlockBits, 2>> blocks;  ///< misses and hits
    std::vector<std::pair<::octomap::OcTreeKey, bool>> cells;

    void add(const Voxel& v, bool is_hit) {
        std::array<BlockBits, 2>& block = blocks.at(v);
        const unsigned place = place_of(v);
        if (((block[0][word_of(place)] | block[1][word_of(place)]) & bit_of(place)) != 0) return;
        block[is_hit][word_of(place)] |= bit_of(place);
        cells.push_back({{static_cast<::octomap::key_type>(v.x), static_cast<::octomap::key_type>(v.y),
                          static_cast<::octomap::key_type>(v.z)},
                         is_hit});
    }
    void enter_ours(::octomap::OcTree& tree) const {
        TreeUpdate update(tree);
        for (std::size_t i = 0; i < blocks.size(); ++i)
            update.update(blocks.low(i), blocks[i][0], blocks[i][1]);
    }
    void enter_theirs(::octomap::OcTree& tree) const {
        for (const auto& [key, is_hit] : cells) tree.updateNode(key, is_hit, true);
    }
};

/// Every node and its value. What is not pruned shows.
bool is_same(const ::octomap::OcTree& a, const ::octomap::OcTree& b) {
    return a.size() == b.size() && ot_of(a) == ot_of(b);
}

TEST(TreeUpdate, DoesAsOctomapDoesWithEachCell) {
    std::mt19937_64 random(5);
    std::uniform_int_distribution<int> near(-20, 20), far(-kMiddle, kMiddle - 1), percent(0, 99);
    ::octomap::OcTree ours(0.05), theirs(0.05);
    for (int round = 0; round < 30; ++round) {
        Scan scan;
        for (int i = 0; i < 3000; ++i) {
            const auto c = [&] { return kMiddle + (i % 50 == 0 ? far(random) : near(random)); };
            scan.add({c(), c(), c()}, percent(random) < 30);
        }
        scan.enter_ours(ours);
        scan.enter_theirs(theirs);
        ASSERT_TRUE(is_same(ours, theirs)) << round;
        if (round % 4 != 3) continue;  // and into pruned trees
        bring_up_to_date(ours);
        bring_up_to_date(theirs);
        ASSERT_TRUE(is_same(ours, theirs)) << round;
    }
    EXPECT_GT(ours.size(), 10000u);
}

/// A leaf above cells that is as sure as it can be stays whole, unless something else was seen in it.
TEST(TreeUpdate, ExpandsAPrunedLeafOnlyForNews) {
    ::octomap::OcTree ours(0.05), theirs(0.05);
    const auto whole = [](bool is_hit, std::int32_t edge) {
        Scan scan;
        for (std::int32_t i = 0; i < edge * edge * edge; ++i)
            scan.add({kMiddle + i % edge, kMiddle + i / edge % edge, kMiddle + i / (edge * edge)}, is_hit);
        return scan;
    };
    const auto both = [&](const Scan& scan) {
        scan.enter_ours(ours);
        scan.enter_theirs(theirs);
        EXPECT_TRUE(is_same(ours, theirs));
    };
    for (int i = 0; i < 20; ++i) both(whole(false, 16));
    bring_up_to_date(ours);
    bring_up_to_date(theirs);
    const std::size_t pruned = ours.size();
    both(whole(false, 4));
    EXPECT_EQ(ours.size(), pruned);
    Scan news;
    news.add({kMiddle + 5, kMiddle + 6, kMiddle + 7}, true);
    both(news);
    EXPECT_GT(ours.size(), pruned);
}

TEST(TreeUpdate, OfNothingMakesNothing) {
    ::octomap::OcTree tree(0.05);
    TreeUpdate(tree).update({kMiddle, kMiddle, kMiddle}, {}, {});
    EXPECT_EQ(tree.size(), 0u);
}

}  // namespace
}  // namespace planemap::octomap
