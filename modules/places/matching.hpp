// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap::places {

/// Number of bits in which two descriptors differ, 0 to 256.
inline int hamming_distance(const Descriptor& a, const Descriptor& b) {
    std::uint64_t words_a[4], words_b[4];
    std::memcpy(words_a, a.data(), sizeof(words_a));
    std::memcpy(words_b, b.data(), sizeof(words_b));
    return std::popcount(words_a[0] ^ words_b[0]) + std::popcount(words_a[1] ^ words_b[1]) +
           std::popcount(words_a[2] ^ words_b[2]) + std::popcount(words_a[3] ^ words_b[3]);
}

/// Descriptor a[first] matches b[second].
struct Match {
    int first = -1, second = -1;
};

struct MatchingOptions {
    int max_distance = 64;  ///< bits in which two descriptors of one point may differ
    double ratio = 0.85;    ///< the best distance is below this times the second best
};

/// Pairs that are each other's nearest, near enough and, from both sides, clearly nearer than the second.
/// Ascending `first`.
std::vector<Match> match(std::span<const Descriptor> a, std::span<const Descriptor> b,
                         const MatchingOptions& options);

/// All pairs within max_distance, of each descriptor of b its `most` nearest ones: what comes again in a view
/// has like descriptors, of which match() takes none or one. Ascending `second`.
std::vector<Match> match_all(std::span<const Descriptor> a, std::span<const Descriptor> b, int max_distance,
                             int most);

}  // namespace planemap::places
