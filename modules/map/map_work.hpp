// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace planemap::map {

/// What a mapper did so far that changes what the map goes on from.
struct MapWork {
    std::size_t coarsened =
        0;                     ///< planes of start_from() whose shape goes on in cells coarser than asked for
    std::size_t folded = 0;    ///< keyframes whose regions were folded into the planes (fold_after)
    std::size_t replaced = 0;  ///< keyframes whose regions went over to others
    std::size_t rebuilds = 0;  ///< of the whole map

    MapWork& operator+=(const MapWork& other);
};

inline MapWork& MapWork::operator+=(const MapWork& other) {
    for (const auto count : {&MapWork::coarsened, &MapWork::folded, &MapWork::replaced, &MapWork::rebuilds})
        this->*count += other.*count;
    return *this;
}

}  // namespace planemap::map
