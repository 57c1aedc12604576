// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/scan_insertion.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace planemap::octomap {
namespace {

std::vector<::octomap::point3d> random_scan(std::mt19937_64& random, std::size_t size) {
    std::uniform_real_distribution<float> across(-1.5f, 1.5f), depth(0.5f, 5.0f);
    std::vector<::octomap::point3d> scan;
    for (std::size_t i = 0; i < size; ++i) {
        const float z = depth(random);
        scan.emplace_back(across(random) * z, across(random) * z, z);
    }
    return scan;
}

void insert_with_octomap(::octomap::OcTree& tree, const std::vector<::octomap::point3d>& points,
                         const ::octomap::point3d& origin, double max_range) {
    ::octomap::Pointcloud scan;
    for (const auto& p : points) scan.push_back(p);
    tree.insertPointCloud(scan, origin, max_range, true, true);
}

TEST(ScanInserter, GivesTheTreeThatOctomapGives) {
    for (const double resolution : {0.05, 0.13}) {
        for (const double max_range : {-1.0, 3.0}) {
            std::mt19937_64 random(3);
            ::octomap::OcTree ours(resolution), theirs(resolution);
            ScanInserter inserter;
            for (int i = 0; i < 6; ++i) {
                const auto scan = random_scan(random, 2000);
                const ::octomap::point3d origin(0.1f * static_cast<float>(i), -0.07f, 0.3f);
                inserter.insert(ours, scan, origin, max_range);
                insert_with_octomap(theirs, scan, origin, max_range);
            }
            for (::octomap::OcTree* tree : {&ours, &theirs}) {
                tree->updateInnerOccupancy();
                tree->prune();
            }
            EXPECT_GT(ours.size(), 1000u);
            EXPECT_TRUE(ours == theirs) << resolution << " " << max_range;
        }
    }
}

/// Rays along the axes and diagonals, where cells' borders are met at once, and from anywhere in a cell.
TEST(ScanInserter, PassesTheCellsThatOctomapPasses) {
    for (const double resolution : {0.01, 0.05, 0.3}) {
        std::mt19937_64 random(7);
        std::uniform_int_distribution<int> steps(-20, 20);
        std::uniform_real_distribution<float> anywhere(-2, 2);
        ::octomap::OcTree ours(resolution), theirs(resolution);
        ScanInserter inserter;
        for (int i = 0; i < 300; ++i) {
            const auto edge = static_cast<float>(resolution);
            const auto c = [&] {
                if (i % 3 == 0) return anywhere(random);
                const int cells = steps(random) / (1 + i % 7);
                return edge * ((i % 3 == 1 ? 0.5f : 0.0f) + static_cast<float>(cells));
            };
            const ::octomap::point3d origin(c(), c(), c());
            const std::vector<::octomap::point3d> scan{
                {c(), c(), c()}, {origin.x(), c(), origin.z()}, {c(), origin.y(), origin.z()}, origin};
            inserter.insert(ours, scan, origin, 3);
            insert_with_octomap(theirs, scan, origin, 3);
        }
        for (::octomap::OcTree* tree : {&ours, &theirs}) {
            tree->updateInnerOccupancy();
            tree->prune();
        }
        EXPECT_GT(ours.size(), 300u);
        EXPECT_TRUE(ours == theirs) << resolution;
    }
}

TEST(ScanInserter, IgnoresPointsThatTheTreeCannotHold) {
    ::octomap::OcTree tree(0.05);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const std::vector<::octomap::point3d> scan{{nan, 0, 0}, {0, inf, 1}, {1e9f, 0, 0}};
    ScanInserter().insert(tree, scan, {0, 0, 0}, 5);
    EXPECT_EQ(tree.size(), 0u);
    ScanInserter().insert(tree, {}, {0, 0, 0}, 5);
    EXPECT_EQ(tree.size(), 0u);
}

}  // namespace
}  // namespace planemap::octomap
