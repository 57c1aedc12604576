// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace planemap::map {
namespace {

TEST(EvidenceCells, CountLikeSixtyFourPlainCounters) {
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 20; ++trial) {
        EvidenceCells cells;
        std::array<int, 64> hits{}, misses{};
        for (int i = 0; i < 12; ++i) {
            const std::uint64_t which = random();
            const int strength = static_cast<int>(random() % 4);
            const bool is_hit = random() % 2 == 0;
            is_hit ? cells.add_hits(which, strength) : cells.add_misses(which, strength);
            std::array<int, 64>& counts = is_hit ? hits : misses;
            for (std::size_t c = 0; c < 64; ++c) {
                if ((which >> c & 1) != 0)
                    counts[c] = std::min(EvidenceCells::kMaxCount, counts[c] + (1 << strength));
            }
        }
        for (std::size_t c = 0; c < 64; ++c) {
            const auto is_set = [&](std::uint64_t bits) { return (bits >> c & 1) != 0; };
            const bool refuted = misses[c] > hits[c];
            EXPECT_EQ(cells.hits(static_cast<int>(c)), hits[c]);
            EXPECT_EQ(cells.misses(static_cast<int>(c)), misses[c]);
            EXPECT_EQ(is_set(cells.refuted()), refuted);
            EXPECT_EQ(is_set(cells.uncertain()),
                      hits[c] > 0 && hits[c] < EvidenceCells::kCertain && !refuted);
            for (int least = 1; least <= EvidenceCells::kMaxCount; ++least)
                EXPECT_EQ(is_set(cells.at_least(least)), hits[c] >= least);
        }
    }
}

TEST(EvidenceCells, OfNothingAreNothing) {
    EvidenceCells cells;
    cells.add_hits(0, 2);
    EXPECT_EQ(cells.at_least(1), 0u);
    EXPECT_EQ(cells.refuted(), 0u);
    EXPECT_EQ(cells.uncertain(), 0u);
    EXPECT_EQ(cells.at_least(0), ~std::uint64_t{0});
}

}  // namespace
}  // namespace planemap::map
