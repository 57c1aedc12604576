// SPDX-License-Identifier: BSD-3-Clause
#include "exports/triangulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/trace.hpp"

namespace planemap::exports {
namespace {

double covered(const Triangulation& t) {
    double total = 0;
    for (const auto& [a, b, c] : t.triangles) {
        const auto at = [&](int i) { return t.vertices[static_cast<std::size_t>(i)]; };
        const double one = signed_area(Ring{at(a), at(b), at(c)});
        EXPECT_GE(one, 0) << "not counter-clockwise";
        total += one;
    }
    return total;
}

/// How many triangles hold a point.
int covers(const Triangulation& t, const Eigen::Vector2d& p) {
    int count = 0;
    for (const auto& [a, b, c] : t.triangles) {
        const auto at = [&](int i) { return t.vertices[static_cast<std::size_t>(i)]; };
        count += contains(Outline{{Ring{at(a), at(b), at(c)}}}, p);
    }
    return count;
}

Ring star(const Eigen::Vector2d& centre, double radius, int points, double phase) {
    Ring ring;
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points + phase, r = i % 2 ? 0.5 * radius : radius;
        ring.push_back(centre + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return ring;
}

TEST(Triangulation, CoversHolesIslandsAndPartsOnce) {
    const Outline outline{{star({0, 0}, 2.4, 24, 0.1), star({0.2, 0.1}, 0.9, 10, 0.3),
                           star({0.2, 0.1}, 0.3, 8, 0), Ring{{3, 0}, {4, 0}, {4, 1}, {3, 1}}}};
    const Triangulation t = triangulate(outline);
    EXPECT_NEAR(covered(t), area(outline), 1e-9);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> x(-2.5, 4.5), y(-2.5, 2.5);
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector2d p(x(random), y(random));
        EXPECT_EQ(covers(t, p), contains(outline, p) ? 1 : 0);
    }
    EXPECT_LT(t.triangles.size(), 4 * outline.vertex_count());
}

/// Each edge was compared with each other one: a minute for the dust of one large plane.
TEST(Triangulation, EndsForDust) {
    Outline dust;
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> jitter(0, 0.5);
    for (int i = 0; i < 30000; ++i) {
        const double x = i % 173, y = i / 173 + jitter(random);
        dust.rings.push_back({{x, y}, {x + 0.2, y}, {x + 0.2, y + 0.2}});
    }
    const Triangulation t = triangulate(dust);
    EXPECT_EQ(t.triangles.size(), 30000u);
    EXPECT_NEAR(covered(t), 30000 * 0.02, 1e-6);
}

TEST(Triangulation, OfRasterOutlines) {
    std::mt19937_64 random(2);
    std::bernoulli_distribution set(0.6);
    for (int trial = 0; trial < 20; ++trial) {
        Mask mask(20, 15);
        int cells = 0;
        for (auto& cell : mask.cells) cells += cell = set(random);
        EXPECT_NEAR(covered(triangulate(test::trace(mask))), cells, 1e-9);
    }
}

TEST(Triangulation, OfRingsThatCross) {
    const Outline bow{{Ring{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}};
    EXPECT_NEAR(covered(triangulate(bow)), 0.5, 1e-9);
}

TEST(Triangulation, OfNothing) {
    EXPECT_TRUE(triangulate({}).triangles.empty());
    EXPECT_TRUE(triangulate({{Ring{{0, 0}, {1, 0}, {2, 0}}}}).triangles.empty());
}

}  // namespace
}  // namespace planemap::exports
