// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap::graph {

/// Finds places by their looks. Descriptors are hashed by a few fixed random choices of 16 of their bits
/// (locality-sensitive hashing); each hash value lists the places that have it. A place scores for each hash
/// it shares with the query, the more the rarer the hash is. Places are numbered in the order they are added.
class PlaceIndex {
  public:
    PlaceIndex();

    /// Adds the next place.
    void add(std::span<const Descriptor> descriptors);
    int size() const { return size_; }
    /// A score for each place, at least 0; it is the share of the query's weight that the place has too.
    std::vector<double> scores(std::span<const Descriptor> descriptors) const;

  private:
    static constexpr std::size_t kTables = 6, kBits = 16;
    using Words = std::array<std::vector<std::uint16_t>, kTables>;

    Words words(std::span<const Descriptor> descriptors) const;

    int size_ = 0;
    std::array<std::array<std::uint8_t, kBits>, kTables> bits_{};
    std::array<std::vector<std::vector<std::int32_t>>, kTables> places_of_;
};

}  // namespace planemap::graph
