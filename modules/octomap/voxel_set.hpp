// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "octomap/block_table.hpp"

namespace planemap::octomap {

/// A set of voxels, kept as bitmaps of 8x8x8 blocks in a hash table: neighbours share a block, so insertion
/// along rays and surfaces is fast and a voxel costs a few bytes.
class VoxelSet {
  public:
    static constexpr std::int32_t kMaxCoordinate = kMaxVoxelCoordinate;

    /// True when the voxel was not in the set.
    bool insert(const Voxel& v) {
        const unsigned place = place_of(v);
        std::uint64_t& word = blocks_.at(v)[word_of(place)];
        const bool is_new = (word & bit_of(place)) == 0;
        word |= bit_of(place);
        size_ += is_new;
        return is_new;
    }
    bool contains(const Voxel& v) const {
        const BlockBits* block = blocks_.find_at(v);
        const unsigned place = place_of(v);
        return block != nullptr && ((*block)[word_of(place)] & bit_of(place)) != 0;
    }
    std::size_t size() const { return size_; }
    std::size_t memory_bytes() const { return blocks_.memory_bytes(); }
    /// Empties the set and keeps its memory.
    void clear() {
        blocks_.clear();
        size_ = 0;
    }

    /// Calls visit(Voxel) for each voxel, block by block in order of first insertion.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t i = 0; i < blocks_.size(); ++i) for_each_voxel(blocks_.low(i), blocks_[i], visit);
    }

  private:
    BlockTable<BlockBits> blocks_;
    std::size_t size_ = 0;
};

}  // namespace planemap::octomap
