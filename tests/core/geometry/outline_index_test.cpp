// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/outline_index.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace planemap {
namespace {

/// A ring with many vertices between two radii.
Ring star(std::mt19937_64& random, int n, double inner, double outer) {
    std::uniform_real_distribution<double> radius(inner, outer);
    Ring ring;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n, r = radius(random);
        ring.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
    return ring;
}

TEST(OutlineIndex, AnswersAsTheOutlineItself) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> at(-2.5, 2.5), reach(0, 0.5);
    for (const int n : {3, 8, 500}) {
        Outline outline{{star(random, n, 1, 2), star(random, 5, 0.2, 0.6)}};
        const OutlineIndex index(outline);
        for (int i = 0; i < 5000; ++i) {
            Eigen::Vector2d p(at(random), at(random));
            if (i % 10 == 0)
                p.y() = outline.rings[0][static_cast<std::size_t>(i) % outline.rings[0].size()].y();
            ASSERT_EQ(index.contains(p), contains(outline, p));
            const double within = reach(random), expected = distance(outline, p);
            ASSERT_EQ(index.distance_within(p, within),
                      expected <= within ? expected : std::numeric_limits<double>::infinity());
            std::vector<double> xs;
            index.crossings(p.y(), xs);
            const auto beyond = std::count_if(xs.begin(), xs.end(), [&](double x) { return p.x() < x; });
            ASSERT_EQ(beyond % 2 == 1, contains(outline, p));
            ASSERT_EQ(xs.size() % 2, 0u);
        }
    }
}

TEST(OutlineIndex, NamesTheRingsAroundAPoint) {
    std::mt19937_64 random(3);
    const Outline outline{{star(random, 30, 1, 2), star(random, 9, 0.2, 0.6), star(random, 40, 0.7, 0.9)}};
    const OutlineIndex index(outline);
    std::uniform_real_distribution<double> at(-2.5, 2.5);
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector2d p(at(random), at(random));
        std::vector<std::size_t> expected;
        for (std::size_t ring = 0; ring < 3; ++ring) {
            if (contains(Outline{{outline.rings[ring]}}, p)) expected.push_back(ring);
        }
        ASSERT_EQ(index.rings_around(p), expected);
    }
}

TEST(OutlineIndex, OfNothingOrOfALine) {
    const OutlineIndex nothing{Outline()}, line{Outline{{{{0, 1}, {1, 1}, {2, 1}}}}};
    EXPECT_FALSE(nothing.contains({0, 0}));
    EXPECT_EQ(nothing.distance_within({0, 0}, 1), std::numeric_limits<double>::infinity());
    EXPECT_FALSE(line.contains({1, 1}));
    EXPECT_EQ(line.distance_within({1, 1.5}, 1), 0.5);
}

TEST(OutlineIndex, LooksAtFewEdges) {
    std::mt19937_64 random(2);
    const OutlineIndex index(Outline{{star(random, 20000, 1, 1.001)}});
    std::vector<double> xs;
    for (int i = 0; i < 1000; ++i) index.crossings(-0.9 + 0.0018 * i, xs);
    EXPECT_LT(index.work(), 1000u * 200u) << "of 20,000 edges";
}

}  // namespace
}  // namespace planemap
