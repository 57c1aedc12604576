// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap::places {

/// Finds places by their looks. Descriptors are hashed by a few fixed random choices of 16 of their bits
/// (locality-sensitive hashing); each hash value lists the places that have it. A place scores for each hash
/// it shares with the query, the more the rarer the hash is. Places are numbered in the order they are added;
/// the number of one that was removed is given to the next. A hash that more than 256 places have tells no
/// place any more and lists none: that bounds a query to 6 x 256 steps a descriptor and the index to 800 MB,
/// however many places there are (10,000 with 600 descriptors each take about 290 MB).
class PlaceIndex {
  public:
    PlaceIndex();

    /// Adds a place and returns its number.
    int add(std::span<const Descriptor> descriptors);
    /// Forgets a place; give the descriptors that it was added with.
    void remove(int place, std::span<const Descriptor> descriptors);
    /// Places there are.
    int size() const { return numbers_ - static_cast<int>(free_.size()); }
    std::size_t memory_bytes() const;
    /// A score for each number, at least 0; it is the share of the query's weight that the place has too.
    std::vector<double> scores(std::span<const Descriptor> descriptors) const;

  private:
    static constexpr std::size_t kTables = 6, kBits = 16, kMostPlaces = 256;

    /// A place in a list; lists share one pool, since most hold one place or two.
    struct Entry {
        std::int32_t place, next;  ///< next entry, -1: the last
    };
    /// Places that have one hash.
    struct Listing {
        std::int32_t first = -1;  ///< entry; -1: none, also when they are too many
        std::int32_t count = 0;   ///< places that have it, listed or not
        std::int32_t listed = 0;
    };
    using Words = std::array<std::vector<std::uint16_t>, kTables>;

    Words words(std::span<const Descriptor> descriptors) const;
    void list(Listing& listing, std::int32_t place);
    /// Takes an entry out of its list, given what points to it.
    void unlist(Listing& listing, std::int32_t& link);

    int numbers_ = 0;        ///< given so far
    std::vector<int> free_;  ///< of removed places
    std::array<std::array<std::uint8_t, kBits>, kTables> bits_{};
    std::array<std::vector<Listing>, kTables> places_of_;
    std::deque<Entry> entries_;
    std::int32_t first_unused_ = -1;
};

}  // namespace planemap::places
