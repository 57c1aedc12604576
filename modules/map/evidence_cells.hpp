// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace planemap::map {

/// How often 64 neighbouring cells were hit (seen) and missed (seen past), 0 to kMaxCount each: bit s of the
/// counts of all of them is one word, so that 64 cells are counted and compared at once.
class EvidenceCells {
  public:
    static constexpr int kMaxCount = 15;
    static constexpr int kCertain = 12;  ///< misses do not count any more against so many hits

    /// Adds 2^strength (strength 0 to 3) to the counts of the cells that are set; they stay at kMaxCount.
    void add_hits(std::uint64_t cells, int strength) { add(hit_, cells, strength); }
    void add_misses(std::uint64_t cells, int strength) { add(miss_, cells, strength); }

    int hits(int cell) const { return count(hit_, cell); }
    int misses(int cell) const { return count(miss_, cell); }

    /// The cells with so many hits or more.
    std::uint64_t at_least(int hits) const {
        // Greater at the highest bit that differs, or equal.
        std::uint64_t greater = 0, equal = ~std::uint64_t{0};
        for (std::size_t s = 4; s-- > 0;) {
            if ((hits >> s & 1) != 0) {
                equal &= hit_[s];
            } else {
                greater |= equal & hit_[s];
                equal &= ~hit_[s];
            }
        }
        return greater | equal;
    }
    /// Those with more misses than hits.
    std::uint64_t refuted() const {
        std::uint64_t greater = 0, equal = ~std::uint64_t{0};
        for (std::size_t s = 4; s-- > 0;) {
            greater |= equal & miss_[s] & ~hit_[s];
            equal &= ~(miss_[s] ^ hit_[s]);
        }
        return greater;
    }
    /// Those that are hit and not refuted, with less than kCertain hits: misses may still refute them.
    std::uint64_t uncertain() const {
        const std::uint64_t weak = (hit_[0] | hit_[1] | hit_[2] | hit_[3]) & ~(hit_[3] & hit_[2]);
        return weak == 0 ? 0 : weak & ~refuted();
    }

  private:
    using Counts = std::array<std::uint64_t, 4>;

    static void add(Counts& counts, std::uint64_t cells, int strength) {
        std::uint64_t carry = cells;
        for (auto s = static_cast<std::size_t>(strength); s < counts.size(); ++s) {
            const std::uint64_t both = counts[s] & carry;
            counts[s] ^= carry;
            carry = both;
        }
        for (std::uint64_t& bits : counts) bits |= carry;
    }
    static int count(const Counts& counts, int cell) {
        int value = 0;
        for (std::size_t s = 0; s < counts.size(); ++s) value |= static_cast<int>(counts[s] >> cell & 1) << s;
        return value;
    }

    Counts hit_{}, miss_{};
};

}  // namespace planemap::map
