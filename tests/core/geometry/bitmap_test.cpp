// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/bitmap.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/trace.hpp"

namespace planemap {
namespace {

/// A bitmap of 3 words from word -1 on, and the same cells as a Mask; cell (x, y) of the one is (x + 64, y +
/// 5) of the other.
struct Twins {
    Bitmap bits{-1, -5, 3, 40};
    Mask mask{192, 40};

    void set(int x, int y) {
        bits.row(y)[(x >> 6) + 1] |= std::uint64_t{1} << (x & 63);
        mask.set(x + 64, y + 5);
    }
};

Twins random_twins(std::uint64_t seed, double density) {
    std::mt19937_64 random(seed);
    std::bernoulli_distribution set(density);
    Twins twins;
    for (int y = -2; y < 32; ++y)
        for (int x = -61; x < 125; ++x)
            if (set(random)) twins.set(x, y);
    return twins;
}

template <typename IsSet>
void expect_cells(const Bitmap& bits, const IsSet& is_set) {
    for (int y = -5; y < 35; ++y)
        for (int x = -64; x < 128; ++x) ASSERT_EQ(bits.at(x, y), is_set(x + 64, y + 5)) << x << " " << y;
}

TEST(Bitmap, WithoutAnotherItHasWhatThatHasNot) {
    const Twins a = random_twins(2, 0.5), b = random_twins(3, 0.5);
    Bitmap left = a.bits;
    left -= b.bits;
    expect_cells(left, [&](int x, int y) { return a.mask.at(x, y) && !b.mask.at(x, y); });
    left -= left;
    EXPECT_EQ(left.count(), 0u);
}

TEST(Bitmap, HasTheCellsThatWereSet) {
    const Twins twins = random_twins(1, 0.5);
    expect_cells(twins.bits, [&](int x, int y) { return twins.mask.at(x, y); });
    EXPECT_EQ(twins.bits.count(),
              static_cast<std::size_t>(std::count(twins.mask.cells.begin(), twins.mask.cells.end(), 1)));
    EXPECT_FALSE(twins.bits.at(1000, 0));
    EXPECT_FALSE(twins.bits.at(0, -1000));
}

TEST(Bitmap, OpensAndClosesAsTheDefinitionSays) {
    for (const double density : {0.2, 0.6, 0.9}) {
        const Twins twins = random_twins(7, density);
        const auto each = [](const Mask& mask, bool all) {
            Mask result(mask.width, mask.height);
            for (int y = 0; y < mask.height; ++y) {
                for (int x = 0; x < mask.width; ++x) {
                    bool every = true, any = false;
                    for (int dy = -1; dy <= 1; ++dy) {
                        for (int dx = -1; dx <= 1; ++dx) {
                            every = every && mask.at(x + dx, y + dy);
                            any = any || mask.at(x + dx, y + dy);
                        }
                    }
                    if (all ? every : any) result.set(x, y);
                }
            }
            return result;
        };
        const Mask opened = each(each(twins.mask, true), false), closed = each(each(twins.mask, false), true);
        expect_cells(twins.bits.opened(1), [&](int x, int y) { return opened.at(x, y); });
        expect_cells(twins.bits.closed(1), [&](int x, int y) { return closed.at(x, y); });
    }
}

TEST(Bitmap, TracesWhatTheMaskTraces) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Twins twins = random_twins(seed, 0.05 * static_cast<double>(seed + 1));
        const Outline bits = twins.bits.trace(), mask = test::trace(twins.mask);
        EXPECT_EQ(bits.rings.size(), mask.rings.size());
        EXPECT_EQ(bits.vertex_count(), mask.vertex_count());
        EXPECT_DOUBLE_EQ(area(bits), static_cast<double>(twins.bits.count()));
        Mask filled(192, 40);
        Outline shifted = bits;
        for (Ring& ring : shifted.rings)
            for (Eigen::Vector2d& v : ring) v += Eigen::Vector2d(64, 5);
        fill(shifted, filled);
        EXPECT_EQ(filled.cells, twins.mask.cells);
    }
}

TEST(Bitmap, DrawsTheCellsWhoseCentreIsInside) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> c(-100, 170);  // some of it beside the bitmap, on every side
    Bitmap bits;
    for (int trial = 0; trial < 30; ++trial) {
        FlatPolygon polygon;
        for (int i = 0; i < 12; ++i) polygon.vertices.emplace_back(c(random), 0.3 * c(random));
        polygon.ring_ends = {7, 12};
        bits.reset(-1, -5, 3, 40);
        bits.draw(polygon,
                  [](const Eigen::Vector2d& v) { return Eigen::Vector2d(v.x() + 63.5, v.y() + 4.5); });
        for (int y = -5; y < 35; ++y)
            for (int x = -64; x < 128; ++x)
                ASSERT_EQ(bits.at(x, y), contains(polygon, {x + 0.5, y + 0.5})) << x << " " << y;
    }
}

TEST(Bitmap, StaysInItsMemoryWhateverIsDrawn) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                     kInf = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& odd : {Eigen::Vector2d(kNan, 1), Eigen::Vector2d(1, kNan),
                                       Eigen::Vector2d(kInf, kInf), Eigen::Vector2d(1e300, -1e300)}) {
        FlatPolygon polygon{{{0, 0}, {5, 0}, odd}, {3}};
        Bitmap bits(0, 0, 1, 10);
        bits.draw(polygon, [](const Eigen::Vector2d& v) { return v; });
        EXPECT_LE(bits.count(), 640u);  // what it draws then does not matter: the sanitizers watch where
    }
}

TEST(Bitmap, Empty) {
    EXPECT_TRUE(Bitmap().trace().empty());
    EXPECT_TRUE(Bitmap(0, 0, 2, 2).opened(1).trace().empty());
    EXPECT_EQ(Bitmap().count(), 0u);
}

}  // namespace
}  // namespace planemap
