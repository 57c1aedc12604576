// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/voxel_set.hpp"

#include <algorithm>

namespace planemap::octomap {

void VoxelSet::clear() {
    keys_.clear();
    bits_.clear();
    size_ = 0;
    last_key_ = ~std::uint64_t{0};
    if (slots_.empty()) rehash(8);
    std::fill(slots_.begin(), slots_.end(), 0);
}

std::size_t VoxelSet::add_block(std::uint64_t key, std::size_t slot) {
    if (2 * (keys_.size() + 1) > slots_.size()) {
        rehash(65 - shift_);
        slot = find(key);
    }
    keys_.push_back(key);
    bits_.push_back({});
    slots_[slot] = static_cast<std::uint32_t>(keys_.size());
    return slot;
}

void VoxelSet::rehash(int log2_slots) {
    shift_ = 64 - log2_slots;
    slots_.assign(std::size_t{1} << log2_slots, 0);
    for (std::size_t i = 0; i < keys_.size(); ++i) slots_[find(keys_[i])] = static_cast<std::uint32_t>(i + 1);
}

}  // namespace planemap::octomap
