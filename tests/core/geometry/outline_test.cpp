// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random_values.hpp"
#include "core/trace.hpp"

namespace planemap {
namespace {

using test::Random;
using test::trace;

Mask random_mask(Random& random, int width, int height, double density) {
    Mask mask(width, height);
    for (auto& cell : mask.cells) cell = random.uniform(0, 1) < density ? 1 : 0;
    return mask;
}

int set_cells(const Mask& mask) {
    return static_cast<int>(
        std::count_if(mask.cells.begin(), mask.cells.end(), [](auto c) { return c != 0; }));
}

Mask from_text(const std::vector<std::string>& rows) {
    Mask mask(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#') mask.set(x, y);
        }
    }
    return mask;
}

Ring square(double x, double y, double side) {
    return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

/// Rings in rings, three deep, and many of them side by side: each counts by how many hold it.
TEST(Outline, AreaOfManyRings) {
    Outline outline;
    const auto square = [](double x, double y, double half) {
        return Ring{{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
    };
    const int n = 100;
    for (int i = 0; i < n * n; ++i) {
        const double x = i % n, y = i / n;
        for (const double half : {0.1, 0.4, 0.2}) outline.rings.push_back(square(x, y, half));
    }
    EXPECT_NEAR(area(outline), n * n * (0.64 - 0.16 + 0.04), 1e-6);
}

TEST(Outline, SignedAreaFollowsTheDirection) {
    Ring ring = square(1, 2, 3);
    EXPECT_DOUBLE_EQ(signed_area(ring), 9);
    std::reverse(ring.begin(), ring.end());
    EXPECT_DOUBLE_EQ(signed_area(ring), -9);
    EXPECT_DOUBLE_EQ(signed_area({}), 0);
}

TEST(Outline, AreaCountsHolesAndIslandsInThem) {
    const Outline outline{{square(0, 0, 10), square(2, 2, 6), square(4, 4, 2), square(20, 0, 1)}};
    EXPECT_DOUBLE_EQ(area(outline), 100 - 36 + 4 + 1);
    EXPECT_DOUBLE_EQ(area({}), 0);
    EXPECT_DOUBLE_EQ(area(Outline{{Ring{}, Ring{{1, 1}}, Ring{{1, 1}, {2, 2}}}}), 0);
}

TEST(Outline, ContainsUnderTheEvenOddRule) {
    const Outline outline{{square(0, 0, 10), square(2, 2, 6)}};
    EXPECT_TRUE(contains(outline, {1, 1}));
    EXPECT_FALSE(contains(outline, {5, 5}));
    EXPECT_FALSE(contains(outline, {11, 5}));
    EXPECT_FALSE(contains({}, {0, 0}));
    EXPECT_FALSE(contains(outline, {NAN, 1}));
}

TEST(Outline, DistanceIsZeroInsideAndToTheNearestEdgeElsewhere) {
    const Outline outline{{square(0, 0, 10), square(2, 2, 6)}};
    EXPECT_DOUBLE_EQ(distance(outline, {1, 1}), 0);
    EXPECT_DOUBLE_EQ(distance(outline, {13, 14}), 5);
    EXPECT_DOUBLE_EQ(distance(outline, {5, 4}), 2) << "inside the hole";
    EXPECT_TRUE(std::isinf(distance(Outline{}, {0, 0})));
}

TEST(Outline, TraceAndFillAreInverse) {
    Random random(1);
    for (int i = 0; i < 60; ++i) {
        const Mask mask =
            random_mask(random, random.integer(1, 40), random.integer(1, 30), random.uniform(0.05, 0.95));
        const Outline outline = trace(mask);
        Mask filled(mask.width, mask.height);
        fill(outline, filled);
        EXPECT_EQ(filled.cells, mask.cells) << "case " << i;
        EXPECT_NEAR(area(outline), set_cells(mask), 1e-9);
        double signed_sum = 0;
        for (const Ring& ring : outline.rings) signed_sum += signed_area(ring);
        EXPECT_NEAR(signed_sum, set_cells(mask), 1e-9) << "outer rings are positive, holes negative";
    }
}

TEST(Outline, TraceHasNoCollinearVertices) {
    Random random(2);
    const Outline outline = trace(random_mask(random, 50, 50, 0.6));
    for (const Ring& ring : outline.rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Eigen::Vector2d a = ring[(i + 1) % ring.size()] - ring[i];
            const Eigen::Vector2d b = ring[(i + 2) % ring.size()] - ring[(i + 1) % ring.size()];
            EXPECT_NE(a.x() * b.y() - a.y() * b.x(), 0.0);
        }
    }
}

TEST(Outline, TraceKeepsCornerTouchingCellsApart) {
    for (const auto& rows : {std::vector<std::string>{"#.", ".#"}, std::vector<std::string>{".#", "#."}}) {
        const Outline outline = trace(from_text(rows));
        ASSERT_EQ(outline.rings.size(), 2u);
        for (const Ring& ring : outline.rings) {
            EXPECT_EQ(ring.size(), 4u);
            EXPECT_DOUBLE_EQ(signed_area(ring), 1);
        }
    }
}

TEST(Outline, TraceOfARingHasAHole) {
    const Outline outline = trace(from_text({"#####", "#...#", "#.#.#", "#...#", "#####"}));
    ASSERT_EQ(outline.rings.size(), 3u);
    EXPECT_DOUBLE_EQ(area(outline), 17);
    EXPECT_FALSE(contains(outline, {1.5, 1.5}));
    EXPECT_TRUE(contains(outline, {2.5, 2.5}));
}

TEST(Outline, TraceAndFillOfNothing) {
    EXPECT_TRUE(trace(Mask{}).empty());
    EXPECT_TRUE(trace(Mask(7, 5)).empty());
    Mask mask(7, 5);
    fill({}, mask);
    EXPECT_EQ(set_cells(mask), 0);
    Mask nothing;
    fill(Outline{{square(0, 0, 3)}}, nothing);
    EXPECT_TRUE(nothing.cells.empty());
}

TEST(Outline, FillClipsAtTheMask) {
    Mask mask(10, 10);
    fill(Outline{{square(-100, -100, 105)}}, mask);
    EXPECT_EQ(set_cells(mask), 25);
    Mask far(10, 10);
    fill(Outline{{square(50, 50, 5)}}, far);
    EXPECT_EQ(set_cells(far), 0);
}

TEST(Outline, FillSurvivesHugeAndNonFiniteVertices) {
    const double big = std::numeric_limits<double>::max(), nan = std::numeric_limits<double>::quiet_NaN();
    Random random(8);
    for (int i = 0; i < 50; ++i) {
        Ring ring;
        for (int k = 0; k < 20; ++k) {
            const double values[] = {big, -big, nan, 0.5, 7.0, std::numeric_limits<double>::infinity()};
            ring.emplace_back(values[random.integer(0, 5)], values[random.integer(0, 5)]);
        }
        Mask mask(8, 8);
        fill(Outline{{ring}}, mask);
        EXPECT_EQ(mask.cells.size(), 64u);
    }
}

TEST(Outline, SimplifiedStaysWithinTheTolerance) {
    Random random(3);
    for (const double tolerance : {0.0, 0.3, 1.0, 2.5}) {
        Ring ring;
        for (int k = 0; k < 200; ++k) {
            const double angle = 2 * M_PI * k / 200, radius = 20 + random.uniform(-1, 1);
            ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        }
        const Outline simple = simplified(Outline{{ring}}, tolerance);
        ASSERT_EQ(simple.rings.size(), 1u);
        for (const auto& vertex : ring) {
            double nearest = std::numeric_limits<double>::infinity();
            const Ring& kept = simple.rings[0];
            for (std::size_t i = 0; i < kept.size(); ++i) {
                const Eigen::Vector2d a = kept[i], ab = kept[(i + 1) % kept.size()] - a;
                const double s = std::clamp((vertex - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
                nearest = std::min(nearest, (vertex - a - s * ab).norm());
            }
            EXPECT_LE(nearest, tolerance + 1e-12);
        }
        for (const auto& vertex : simple.rings[0]) {
            EXPECT_NE(std::find(ring.begin(), ring.end(), vertex), ring.end());
        }
    }
}

TEST(Outline, SimplifiedLeavesOutWhatIsNoArea) {
    const Outline flat{{Ring{{0, 0}, {1, 0}, {2, 0}}, Ring{}, Ring{{1, 1}}, Ring{{1, 1}, {1, 1}, {1, 1}}}};
    EXPECT_TRUE(simplified(flat, 0.01).empty());
    EXPECT_TRUE(simplified(Outline{{square(0, 0, 0.1)}}, 1.0).empty()) << "smaller than the tolerance";
    const Outline stairs = trace(from_text({"####", "####", "####"}));
    EXPECT_EQ(simplified(stairs, 0.1).vertex_count(), 4u);
}

}  // namespace
}  // namespace planemap
