// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/flat_polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace planemap {
namespace {

TEST(FlatPolygon, HoldsWhatItsOutlineHolds) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> c(-1, 1);
    Outline outline;
    for (const int size : {9, 3, 5}) {
        Ring& ring = outline.rings.emplace_back();
        for (int i = 0; i < size; ++i) ring.emplace_back(c(random), c(random));
    }
    FlatPolygon polygon;
    polygon.assign(outline);
    EXPECT_EQ(polygon.vertices.size(), 17u);
    EXPECT_EQ(polygon.ring_ends, (std::vector<std::size_t>{9, 12, 17}));
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector2d p(c(random), c(random));
        ASSERT_EQ(contains(polygon, p), contains(outline, p));
        inside += contains(polygon, p);
    }
    EXPECT_GT(inside, 200);
    polygon.assign({});
    EXPECT_FALSE(contains(polygon, {0, 0}));
}

TEST(FlatPolygon, EdgesCloseEachRing) {
    FlatPolygon polygon{{{0, 0}, {1, 0}, {0, 1}, {5, 5}, {6, 5}, {5, 6}}, {3, 6}};
    double length = 0;
    for_each_edge(polygon, [&](const auto& from, const auto& to) { length += (to - from).norm(); });
    EXPECT_DOUBLE_EQ(length, 2 * (2 + std::sqrt(2)));
}

}  // namespace
}  // namespace planemap
