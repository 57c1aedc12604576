// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/parity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace planemap {
namespace {

TEST(Parity, AgreesWithCountingBitByBit) {
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 100; ++trial) {
        std::array<std::uint64_t, 3> row{random(), random() & random(), 0};
        const std::array<std::uint64_t, 3> flips = row;
        set_between_flips(row);
        bool is_inside = false;
        for (std::size_t i = 0; i < 64 * row.size(); ++i) {
            is_inside ^= (flips[i / 64] >> (i % 64) & 1) != 0;
            ASSERT_EQ((row[i / 64] >> (i % 64) & 1) != 0, is_inside) << trial << " " << i;
        }
    }
}

TEST(Parity, ASpanReachesFromItsFirstCellToBeforeTheOneThatEndsIt) {
    std::array<std::uint64_t, 2> row{std::uint64_t{1} << 60, std::uint64_t{1} << 2};
    set_between_flips(row);
    EXPECT_EQ(row[0], std::uint64_t{15} << 60);
    EXPECT_EQ(row[1], std::uint64_t{3});
    std::array<std::uint64_t, 2> open{1, 0};
    set_between_flips(open);
    EXPECT_EQ(open[0], ~std::uint64_t{0});
    EXPECT_EQ(open[1], ~std::uint64_t{0}) << "nothing ends it";
    set_between_flips({});
}

}  // namespace
}  // namespace planemap
