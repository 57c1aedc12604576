// SPDX-License-Identifier: BSD-3-Clause
// The even-odd rule on a row of cells, 64 at once.
#pragma once

#include <cstdint>
#include <span>

namespace planemap {

/// Bits that are set after an odd number of set bits, themselves included: prefix parity.
inline std::uint64_t parity_up_to(std::uint64_t bits) {
    for (const int shift : {1, 2, 4, 8, 16, 32}) bits ^= bits << shift;
    return bits;
}

/// Of a row whose bits say where one comes in or out, the bits that are inside: cell i is bit i % 64 of word
/// i / 64, and the first cell that is inside is the one where one comes in.
inline void set_between_flips(std::span<std::uint64_t> row) {
    std::uint64_t carried = 0;  // all ones while inside
    for (std::uint64_t& word : row) {
        word = parity_up_to(word) ^ carried;
        carried = (word >> 63) != 0 ? ~std::uint64_t{0} : 0;
    }
}

}  // namespace planemap
