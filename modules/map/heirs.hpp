// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "core/geometry/pose.hpp"
#include "core/heap_bytes.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// Which keyframe near by took the place of one that left the map, and how it lies about that: looks that are
/// still tracked against the one that went are looks from near its heir. Of the last kMost that went.
class Heirs {
  public:
    static constexpr std::size_t kMost = 64;

    /// At their poses now. Precondition: both have one.
    void add(const StoredKeyframe& gone, const StoredKeyframe& heir);

    struct Place {
        int id;
        std::int64_t utime;
    };
    /// From a keyframe that went to its heir, with the pose that is known about it; false if it has none.
    bool follow(Place& place, Pose& keyframe_from_camera) const;

    /// Takes all that others are known to have. Precondition: no id is in both.
    void absorb(Heirs&& other);

    /// On the heap.
    std::size_t memory_bytes() const { return node_bytes(heirs_); }

  private:
    struct Heir {
        std::int64_t gone_utime;
        Place place;
        Pose heir_from_gone;
    };
    std::map<int, Heir> heirs_;  ///< by the id of the keyframe that went
};

}  // namespace planemap::map
