// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace planemap::octomap {

/// A voxel by its integer coordinates, each less than VoxelSet::kMaxCoordinate away from 0.
struct Voxel {
    std::int32_t x = 0, y = 0, z = 0;
    friend bool operator==(const Voxel&, const Voxel&) = default;
};

/// A set of voxels, kept as bitmaps of 8x8x8 blocks in a hash table: neighbours share a block, so insertion
/// along rays and surfaces is fast and a voxel costs a few bytes.
class VoxelSet {
  public:
    static constexpr std::int32_t kMaxCoordinate = 1 << 22;

    VoxelSet() { clear(); }

    /// True when the voxel was not in the set.
    bool insert(const Voxel& v) {
        std::uint64_t& word = bits_[block(v)][word_of(v)];
        const std::uint64_t bit = bit_of(v);
        const bool is_new = (word & bit) == 0;
        word |= bit;
        size_ += is_new;
        return is_new;
    }
    bool contains(const Voxel& v) const {
        const std::size_t slot = find(key_of(v));
        return slots_[slot] != 0 && (bits_[slots_[slot] - 1][word_of(v)] & bit_of(v)) != 0;
    }
    std::size_t size() const { return size_; }
    std::size_t memory_bytes() const {
        return slots_.capacity() * sizeof slots_[0] + keys_.capacity() * sizeof keys_[0] +
               bits_.capacity() * sizeof bits_[0];
    }
    /// Empties the set and keeps its memory.
    void clear();

    /// Calls visit(Voxel) for each voxel, block by block in order of first insertion.
    template <typename Visit>
    void for_each(Visit visit) const {
        for_each_where([](const Voxel&) { return true; }, visit);
    }

    /// The same for the voxels of those 8x8x8 blocks whose lowest voxel is wanted(Voxel).
    template <typename Wanted, typename Visit>
    void for_each_where(Wanted wanted, Visit visit) const {
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            const std::uint64_t key = keys_[i];
            const Voxel low{unpack(key >> 40), unpack(key >> 20), unpack(key)};
            if (!wanted(low)) continue;
            for (int z = 0; z < 8; ++z) {
                for (std::uint64_t word = bits_[i][static_cast<std::size_t>(z)]; word != 0;
                     word &= word - 1) {
                    const int bit = std::countr_zero(word);
                    visit(Voxel{low.x + (bit & 7), low.y + (bit >> 3), low.z + z});
                }
            }
        }
    }

  private:
    using Block = std::array<std::uint64_t, 8>;

    static std::uint64_t pack(std::int32_t c) {
        return static_cast<std::uint64_t>((c >> 3) + (1 << 19)) & 0xfffff;
    }
    static std::int32_t unpack(std::uint64_t c) {
        return (static_cast<std::int32_t>(c & 0xfffff) - (1 << 19)) * 8;
    }
    static std::uint64_t key_of(const Voxel& v) { return pack(v.x) << 40 | pack(v.y) << 20 | pack(v.z); }
    static std::size_t word_of(const Voxel& v) { return static_cast<std::size_t>(v.z & 7); }
    static std::uint64_t bit_of(const Voxel& v) { return std::uint64_t{1} << ((v.y & 7) * 8 + (v.x & 7)); }

    std::size_t find(std::uint64_t key) const {
        std::size_t slot = (key * 0x9e3779b97f4a7c15ull) >> shift_;
        while (slots_[slot] != 0 && keys_[slots_[slot] - 1] != key) slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }
    /// Index of the voxel's block, made if need be.
    std::size_t block(const Voxel& v) {
        const std::uint64_t key = key_of(v);
        if (key == last_key_) return last_block_;
        std::size_t slot = find(key);
        if (slots_[slot] == 0) slot = add_block(key, slot);
        last_key_ = key;
        last_block_ = slots_[slot] - 1;
        return last_block_;
    }
    std::size_t add_block(std::uint64_t key, std::size_t slot);
    void rehash(int log2_slots);

    std::vector<std::uint32_t> slots_;  ///< open addressing: 1 + index of a block, 0 for none
    std::vector<std::uint64_t> keys_;   ///< of the blocks
    std::vector<Block> bits_;
    int shift_ = 0;  ///< 64 - log2 of the number of slots
    std::size_t size_ = 0;
    std::uint64_t last_key_ = ~std::uint64_t{0};  ///< the block used last; no key has all bits set
    std::size_t last_block_ = 0;
};

}  // namespace planemap::octomap
