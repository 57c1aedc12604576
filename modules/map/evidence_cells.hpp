// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/look.hpp"

namespace planemap::map {

/// What is known of 64 neighbouring cells of a plane. Of each: how well it was seen (support, 0 to
/// kMaxSupport, which only grows), and the odds that it is there now: looks that saw it minus looks that saw
/// past it, held between kLeastOdds and kMaxOdds, so that five looks tell what changed whatever went before.
/// Bit s of the counts of all cells is one word, so that 64 cells are counted and compared at once.
class EvidenceCells {
  public:
    static constexpr int kMaxSupport = 15;
    static constexpr int kMaxOdds = kLooksThatCount, kLeastOdds = 1 - kMaxOdds;

    /// Adds 2^strength (strength 0 to 3) to the support of the cells that are set.
    void add_support(std::uint64_t cells, int strength) {
        std::uint64_t carry = cells;
        for (auto s = static_cast<std::size_t>(strength); s < kBits; ++s) {
            const std::uint64_t both = support_[s] & carry;
            support_[s] ^= carry;
            carry = both;
        }
        for (std::uint64_t& bits : support_) bits |= carry;
    }

    /// Looks that saw the cells, or saw past them, after all others.
    void hit(std::uint64_t cells, int looks = 1) {
        for (int i = 0; i < looks; ++i) raise(cells & ~with_odds(kMaxOdds));
    }
    void miss(std::uint64_t cells, int looks = 1) {
        for (int i = 0; i < looks; ++i) lower(cells & ~with_odds(kLeastOdds));
    }
    /// The same of looks before all others, back in time after forget_odds(): where those after them have
    /// decided, they say nothing. At the end, end_back_in_time().
    void hit_before(std::uint64_t cells, int looks = 1) {
        for (int i = 0; i < looks; ++i) raise(cells & ~decided());
    }
    void miss_before(std::uint64_t cells, int looks = 1) {
        for (int i = 0; i < looks; ++i) lower(cells & ~decided());
    }

    int support(int cell) const { return count(support_, cell); }
    int odds(int cell) const {
        const int stored = count(odds_, cell);
        return stored < 8 ? stored : stored - 16;
    }

    /// The cells with so much support or more.
    std::uint64_t supported(int least) const {
        // Greater at the highest bit that differs, or equal.
        std::uint64_t greater = 0, equal = ~std::uint64_t{0};
        for (std::size_t s = kBits; s-- > 0;) {
            if ((least >> s & 1) != 0) {
                equal &= support_[s];
            } else {
                greater |= equal & support_[s];
                equal &= ~support_[s];
            }
        }
        return greater | equal;
    }
    /// Those that were ever seen.
    std::uint64_t seen() const { return support_[0] | support_[1] | support_[2] | support_[3]; }
    /// Those that are there: seen, and more often than seen past, as far back as it counts.
    std::uint64_t present() const { return seen() & ~odds_[3] & (odds_[0] | odds_[1] | odds_[2]); }
    /// Those that were seen and are gone.
    std::uint64_t refuted() const { return seen() & ~present(); }
    /// Those whose odds are kMaxOdds, either way: no look before can change what they say.
    std::uint64_t decided() const { return with_odds(kMaxOdds) | with_odds(-kMaxOdds); }
    std::uint64_t with_odds(int odds) const {
        std::uint64_t equal = ~std::uint64_t{0};
        for (std::size_t s = 0; s < kBits; ++s) equal &= (odds >> s & 1) != 0 ? odds_[s] : ~odds_[s];
        return equal;
    }

    void forget_odds() { odds_ = {}; }
    void end_back_in_time() { raise(with_odds(-kMaxOdds)); }

  private:
    static constexpr std::size_t kBits = 4;
    using Counts = std::array<std::uint64_t, kBits>;

    void raise(std::uint64_t cells) {
        for (std::uint64_t& bits : odds_) {
            const std::uint64_t carry = bits & cells;
            bits ^= cells;
            cells = carry;
        }
    }
    void lower(std::uint64_t cells) {
        for (std::uint64_t& bits : odds_) {
            const std::uint64_t borrow = ~bits & cells;
            bits ^= cells;
            cells = borrow;
        }
    }
    static int count(const Counts& counts, int cell) {
        int value = 0;
        for (std::size_t s = 0; s < kBits; ++s) value |= static_cast<int>(counts[s] >> cell & 1) << s;
        return value;
    }

    Counts support_{};
    Counts odds_{};  ///< two's complement
};

}  // namespace planemap::map
