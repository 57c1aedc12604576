// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_sizes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "core/files.hpp"
#include "heap.hpp"
#include "temporary_folder.hpp"

namespace planemap::octomap {
namespace {

/// Random cells, and two blocks whose cells are all free or all occupied: leaves of several sizes.
::octomap::OcTree random_tree(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    ::octomap::OcTree tree(0.05);
    std::uniform_int_distribution<int> at(32700, 32800), hit(0, 3);
    const auto key = [](int x, int y, int z) {
        return ::octomap::OcTreeKey(static_cast<::octomap::key_type>(x), static_cast<::octomap::key_type>(y),
                                    static_cast<::octomap::key_type>(z));
    };
    for (int i = 0; i < 30000; ++i) {
        const auto k = key(at(random) / 3, at(random) / 2, at(random) / 4);
        tree.updateNode(k, hit(random) == 0, true);
    }
    for (int i = 0; i < 16 * 16 * 16; ++i) {
        // Some of them twice: equal in a .bt file, and not yet in the tree.
        for (int time = 0; time <= i % 5 / 4; ++time)
            tree.updateNode(key(32868 + i % 16, 32868 + i / 16 % 16, 32868 + i / 256), i / 256 < 8, true);
    }
    tree.updateInnerOccupancy();
    tree.prune();
    return tree;
}

/// As OctoMap itself reads a .bt file.
std::unique_ptr<::octomap::OcTree> loaded(const std::string& bt) {
    auto tree = std::make_unique<::octomap::OcTree>(0.05);
    std::istringstream in(bt);
    EXPECT_TRUE(tree->readBinary(in));
    return tree;
}

TEST(OctomapSizes, OfTheFilesNeedNoPruning) {
    ::octomap::OcTree tree = random_tree(4);
    const OctomapSizes pruned = sizes_of(tree);
    tree.expand();
    const OctomapSizes expanded = sizes_of(tree);
    EXPECT_GT(expanded.nodes, pruned.nodes);
    EXPECT_EQ(expanded.bt_nodes, pruned.bt_nodes);
    EXPECT_EQ(expanded.bt_bytes, pruned.bt_bytes);
    EXPECT_EQ(expanded.bt_occupied_bytes, pruned.bt_occupied_bytes);
}

TEST(OctomapSizes, AreThoseThatOctoMapItselfGives) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const ::octomap::OcTree tree = random_tree(seed);
        const OctomapSizes sizes = sizes_of(tree);
        EXPECT_EQ(sizes.memory_bytes, tree.memoryUsage());
        EXPECT_EQ(sizes.nodes, tree.size());
        EXPECT_EQ(sizes.leaves, tree.getNumLeafNodes());
        EXPECT_EQ(sizes.bt_bytes, bt_of(tree).size());
        EXPECT_EQ(sizes.bt_nodes, loaded(bt_of(tree))->size());
        EXPECT_EQ(sizes.ot_bytes, ot_of(tree).size());
        EXPECT_EQ(sizes.bt_loaded_memory_bytes, loaded(bt_of(tree))->memoryUsage());
        EXPECT_LT(sizes.bt_loaded_memory_bytes, sizes.memory_bytes);
    }
}

TEST(OctomapSizes, OnTheHeapATreeTakesWhatIsSaid) {
    if (!test::heap_is_told()) GTEST_SKIP() << "this program's malloc does not tell what it gave out";
    const ::octomap::OcTree tree = random_tree(6);
    const OctomapSizes sizes = sizes_of(tree);
    const auto taken = [](const ::octomap::OcTree& built) {
        const std::size_t before = test::heap_in_use();
        const auto alone = std::make_unique<::octomap::OcTree>(built);
        return static_cast<double>(test::heap_in_use() - before);
    };
    // OctoMap keeps 600 kB to cast rays with, which are not counted: ScanInserter does without.
    const double empty = taken(::octomap::OcTree(0.05));
    const auto expect = [&](const ::octomap::OcTree& built, std::size_t said) {
        const double nodes = taken(built) - empty;
        EXPECT_NEAR(static_cast<double>(said), nodes, 0.02 * nodes);
    };
    expect(tree, sizes.allocated_bytes);
    expect(*loaded(bt_of(tree)), sizes.bt_loaded_allocated_bytes);
    EXPECT_GT(sizes.allocated_bytes, sizes.memory_bytes) << "OctoMap does not count what malloc adds";
}

TEST(OctomapSizes, TheOccupiedPartIsTheFileWithoutFreeSpace) {
    const ::octomap::OcTree tree = random_tree(4);
    const auto likely = loaded(bt_of(tree));
    ::octomap::OcTree occupied(0.05);
    for (auto leaf = likely->begin_leafs(), end = likely->end_leafs(); leaf != end; ++leaf) {
        if (!likely->isNodeOccupied(*leaf)) continue;
        const int n = 1 << (likely->getTreeDepth() - leaf.getDepth());
        const ::octomap::OcTreeKey low = leaf.getIndexKey();
        for (int i = 0; i < n * n * n; ++i) {
            ::octomap::OcTreeKey key = low;
            key[0] = static_cast<::octomap::key_type>(key[0] + i % n);
            key[1] = static_cast<::octomap::key_type>(key[1] + i / n % n);
            key[2] = static_cast<::octomap::key_type>(key[2] + i / (n * n));
            occupied.updateNode(key, true, true);
        }
    }
    occupied.updateInnerOccupancy();
    occupied.prune();
    const OctomapSizes sizes = sizes_of(tree);
    EXPECT_EQ(sizes.bt_occupied_bytes, bt_of(occupied).size());
    EXPECT_EQ(bt_occupied_of(tree), bt_of(occupied)) << "byte by byte";
    EXPECT_LT(sizes.bt_occupied_bytes, sizes.bt_bytes);
}

TEST(OctomapSizes, OfAnEmptyTreeAreItsHeaders) {
    const ::octomap::OcTree tree(0.05);
    const OctomapSizes sizes = sizes_of(tree);
    EXPECT_EQ(sizes.memory_bytes, tree.memoryUsage());
    EXPECT_EQ(sizes.nodes, 0u);
    EXPECT_EQ(sizes.bt_bytes, bt_of(tree).size());
    EXPECT_EQ(sizes.bt_occupied_bytes, bt_of(tree).size());
    EXPECT_EQ(sizes.ot_bytes, ot_of(tree).size());
    EXPECT_EQ(bt_occupied_of(tree), bt_of(tree));
}

TEST(OctomapSizes, AStoredTreeIsReadInSilence) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "map.bt";
    for (const ::octomap::OcTree& tree : {random_tree(5), ::octomap::OcTree(0.1)}) {
        write_file(file, bt_of(tree));
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const auto reread = read_bt(file);
        EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "");
        EXPECT_EQ(bt_of(*reread), bt_of(tree));
        EXPECT_EQ(reread->getResolution(), tree.getResolution());
    }
}

TEST(OctomapSizes, WhatIsNoTreeIsOneLine) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "map.bt";
    const std::string whole = bt_of(random_tree(6));
    std::string colored = whole;
    colored.replace(colored.find("id OcTree"), 9, "id ColTre");
    for (const std::string& bytes :
         {std::string(), std::string("x"), whole.substr(0, 30), whole.substr(0, whole.size() / 2), colored}) {
        write_file(file, bytes);
        testing::internal::CaptureStderr();
        EXPECT_THAT(test::error_of([&] { read_bt(file); }), testing::HasSubstr("map.bt: is no OctoMap"));
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << bytes.size();
    }
}

}  // namespace
}  // namespace planemap::octomap
