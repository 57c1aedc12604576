// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace planemap::octomap {

/// A voxel by its integer coordinates, each less than kMaxVoxelCoordinate away from 0.
struct Voxel {
    std::int32_t x = 0, y = 0, z = 0;
    friend bool operator==(const Voxel&, const Voxel&) = default;
};
inline constexpr std::int32_t kMaxVoxelCoordinate = 1 << 22;

/// A bit for each voxel of a block of 8x8x8, in an octree's order, three bits a level, x lowest: a word is an
/// octant of 4x4x4, a byte of it one of 2x2x2, as OctoMap numbers the children of its nodes.
using BlockBits = std::array<std::uint64_t, 8>;

/// The three bits of a coordinate in its block, each three places from the next: x; y is one place higher, z
/// two.
constexpr unsigned spread(std::int32_t c) {
    const unsigned bits = static_cast<unsigned>(c) & 7;
    return (bits & 1) | (bits & 2) << 2 | (bits & 4) << 4;
}
/// A voxel's place in its block, 0 to 511.
constexpr unsigned place_of(const Voxel& v) {
    return spread(v.x) | spread(v.y) << 1 | spread(v.z) << 2;
}
/// The coordinate (0: x, 1: y, 2: z) that a place has in its block.
constexpr std::int32_t coordinate_of(unsigned place, unsigned axis) {
    const unsigned bits = place >> axis;
    return static_cast<std::int32_t>((bits & 1) | (bits >> 2 & 2) | (bits >> 4 & 4));
}
constexpr std::size_t word_of(unsigned place) {
    return place >> 6;
}
constexpr std::uint64_t bit_of(unsigned place) {
    return std::uint64_t{1} << (place & 63);
}

inline bool any(const BlockBits& bits) {
    return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
}

/// Calls visit(Voxel) for each voxel of a block by its lowest voxel and its bits.
template <typename Visit>
void for_each_voxel(const Voxel& low, const BlockBits& bits, const Visit& visit) {
    for (unsigned octant = 0; octant < bits.size(); ++octant) {
        for (std::uint64_t word = bits[octant]; word != 0; word &= word - 1) {
            const unsigned place = octant << 6 | static_cast<unsigned>(std::countr_zero(word));
            visit(Voxel{low.x + coordinate_of(place, 0), low.y + coordinate_of(place, 1),
                        low.z + coordinate_of(place, 2)});
        }
    }
}

/// Blocks of 8x8x8 voxels by where they are: a hash table. Neighbours share a block, so what is set along
/// rays and surfaces is found fast. A `Block` is a value that begins empty.
template <typename Block>
class BlockTable {
  public:
    BlockTable() { clear(); }

    /// Empties it and keeps its memory.
    void clear() {
        keys_.clear();
        blocks_.clear();
        last_key_ = ~std::uint64_t{0};
        if (slots_.empty()) rehash(8);
        std::fill(slots_.begin(), slots_.end(), 0);
    }

    /// The voxel's block, made if need be; valid until the next one is made.
    Block& at(const Voxel& v) {
        const std::uint64_t key = key_of(v);
        if (key == last_key_) return blocks_[last_block_];
        std::size_t slot = find(key);
        if (slots_[slot] == 0) slot = add(key, slot);
        last_key_ = key;
        last_block_ = slots_[slot] - 1;
        return blocks_[last_block_];
    }
    /// Null where there is none.
    const Block* find_at(const Voxel& v) const {
        const std::size_t slot = find(key_of(v));
        return slots_[slot] == 0 ? nullptr : &blocks_[slots_[slot] - 1];
    }

    /// Blocks in order of first use, and the lowest voxel of each.
    std::size_t size() const { return blocks_.size(); }
    Block& operator[](std::size_t i) { return blocks_[i]; }
    const Block& operator[](std::size_t i) const { return blocks_[i]; }
    Voxel low(std::size_t i) const {
        return {unpack(keys_[i] >> 40), unpack(keys_[i] >> 20), unpack(keys_[i])};
    }

    std::size_t memory_bytes() const {
        return slots_.capacity() * sizeof slots_[0] + keys_.capacity() * sizeof keys_[0] +
               blocks_.capacity() * sizeof(Block);
    }

  private:
    static std::uint64_t pack(std::int32_t c) {
        return static_cast<std::uint64_t>((c >> 3) + (1 << 19)) & 0xfffff;
    }
    static std::int32_t unpack(std::uint64_t c) {
        return (static_cast<std::int32_t>(c & 0xfffff) - (1 << 19)) * 8;
    }
    static std::uint64_t key_of(const Voxel& v) { return pack(v.x) << 40 | pack(v.y) << 20 | pack(v.z); }

    std::size_t find(std::uint64_t key) const {
        std::size_t slot = (key * 0x9e3779b97f4a7c15ull) >> shift_;
        while (slots_[slot] != 0 && keys_[slots_[slot] - 1] != key) slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }
    std::size_t add(std::uint64_t key, std::size_t slot) {
        if (2 * (keys_.size() + 1) > slots_.size()) {
            rehash(65 - shift_);
            slot = find(key);
        }
        keys_.push_back(key);
        blocks_.push_back({});
        slots_[slot] = static_cast<std::uint32_t>(keys_.size());
        return slot;
    }
    void rehash(int log2_slots) {
        shift_ = 64 - log2_slots;
        slots_.assign(std::size_t{1} << log2_slots, 0);
        for (std::size_t i = 0; i < keys_.size(); ++i)
            slots_[find(keys_[i])] = static_cast<std::uint32_t>(i + 1);
    }

    std::vector<std::uint32_t> slots_;  ///< open addressing: 1 + index of a block, 0 for none
    std::vector<std::uint64_t> keys_;   ///< of the blocks
    std::vector<Block> blocks_;
    int shift_ = 0;                               ///< 64 - log2 of the number of slots
    std::uint64_t last_key_ = ~std::uint64_t{0};  ///< the block used last; no key has all bits set
    std::size_t last_block_ = 0;
};

}  // namespace planemap::octomap
