// SPDX-License-Identifier: BSD-3-Clause
#include "map/evidence_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace planemap::map {
namespace {

constexpr int kMost = EvidenceCells::kMaxOdds;
constexpr std::uint64_t kOne = 1;  // the first cell

bool is_set(std::uint64_t bits, std::size_t cell) {
    return (bits >> cell & 1) != 0;
}

TEST(EvidenceCells, CountLikeSixtyFourPlainCounters) {
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 20; ++trial) {
        EvidenceCells cells;
        std::array<int, 64> support{}, odds{};
        for (int i = 0; i < 30; ++i) {
            const std::uint64_t which = random();
            const int strength = static_cast<int>(random() % 4), looks = static_cast<int>(random() % 4);
            const int kind = static_cast<int>(random() % 3);
            if (kind == 0) cells.add_support(which, strength);
            if (kind == 1) cells.hit(which, looks);
            if (kind == 2) cells.miss(which, looks);
            for (std::size_t c = 0; c < 64; ++c) {
                if (!is_set(which, c)) continue;
                if (kind == 0)
                    support[c] = std::min(EvidenceCells::kMaxSupport, support[c] + (1 << strength));
                if (kind == 1) odds[c] = std::min(kMost, odds[c] + looks);
                if (kind == 2) odds[c] = std::max(EvidenceCells::kLeastOdds, odds[c] - looks);
            }
        }
        for (std::size_t c = 0; c < 64; ++c) {
            EXPECT_EQ(cells.support(static_cast<int>(c)), support[c]);
            EXPECT_EQ(cells.odds(static_cast<int>(c)), odds[c]);
            EXPECT_EQ(is_set(cells.seen(), c), support[c] > 0);
            EXPECT_EQ(is_set(cells.present(), c), support[c] > 0 && odds[c] > 0);
            EXPECT_EQ(is_set(cells.refuted(), c), support[c] > 0 && odds[c] <= 0);
            EXPECT_EQ(is_set(cells.decided(), c), odds[c] == kMost);
            for (int least = 1; least <= EvidenceCells::kMaxSupport; ++least)
                EXPECT_EQ(is_set(cells.supported(least), c), support[c] >= least);
            for (int value = -kMost; value <= kMost; ++value)
                EXPECT_EQ(is_set(cells.with_odds(value), c), odds[c] == value);
        }
    }
}

/// Odds of a cell that looks saw (true) and saw past, told in order of time or back in time.
int odds_after(const std::vector<bool>& seen, bool back_in_time) {
    EvidenceCells cells;
    cells.add_support(kOne, 0);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const bool hit = seen[back_in_time ? seen.size() - 1 - i : i];
        if (back_in_time) {
            hit ? cells.hit_before(kOne) : cells.miss_before(kOne);
        } else {
            hit ? cells.hit(kOne) : cells.miss(kOne);
        }
    }
    return cells.odds(0);
}

TEST(EvidenceCells, FiveLooksTellWhateverWentBeforeInEitherOrder) {
    for (const bool back : {false, true}) {
        for (const int before : {1, 2, 5, 100}) {
            for (const bool was : {false, true}) {
                std::vector<bool> seen(static_cast<std::size_t>(before), was);
                for (int now = 1; now <= kMost; ++now) {
                    seen.push_back(!was);
                    const bool is_there = odds_after(seen, back) > 0;
                    const bool should = now >= std::min(before, kMost) ? !was : was;
                    // As many looks for it as against it: it is not there.
                    const bool is_even = !was && now == before && before < kMost;
                    EXPECT_EQ(is_there, should && !is_even) << back << before << was << now;
                }
            }
        }
    }
}

TEST(EvidenceCells, TwoSeenTwoLookedThroughIsGone) {
    for (const bool back : {false, true}) {
        EXPECT_GT(odds_after({true, true, false}, back), 0);
        EXPECT_EQ(odds_after({true, true, false, false}, back), 0);
        EXPECT_GT(odds_after({true}, back), 0) << "in space that nobody saw, at its first look";
        EXPECT_LE(odds_after({false, true}, back), 0);
        EXPECT_GT(odds_after({false, true, true}, back), 0);
    }
}

TEST(EvidenceCells, OfNothingAreNothing) {
    EvidenceCells cells;
    cells.add_support(0, 2);
    cells.hit(0);
    cells.hit(kOne, 0);
    EXPECT_EQ(cells.supported(1), 0u);
    EXPECT_EQ(cells.refuted(), 0u);
    EXPECT_EQ(cells.present(), 0u);
    EXPECT_EQ(cells.supported(0), ~std::uint64_t{0});
    cells.hit(kOne);
    EXPECT_EQ(cells.present(), 0u) << "odds without support";
    cells.forget_odds();
    EXPECT_EQ(cells.odds(0), 0);
}

}  // namespace
}  // namespace planemap::map
