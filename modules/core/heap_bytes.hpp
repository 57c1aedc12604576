// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

namespace planemap {

/// What a block of so many bytes takes on the heap, by glibc's malloc: a header of 8 bytes, in steps of 16,
/// 32 at the least.
constexpr std::size_t heap_bytes(std::size_t bytes) {
    return bytes == 0 ? 0 : std::max<std::size_t>(32, (bytes + 8 + 15) / 16 * 16);
}

/// What the nodes of a std::map or std::set take on the heap.
template <typename Map>
constexpr std::size_t node_bytes(const Map& map) {
    constexpr std::size_t kNode = 4 * sizeof(void*);  // colour, parent, two children
    return map.size() * heap_bytes(kNode + sizeof(typename Map::value_type));
}

}  // namespace planemap
