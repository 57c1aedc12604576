// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "map/free_space.hpp"
#include "map/plane_set.hpp"
#include "map/region_joiner.hpp"

namespace planemap::map {

/// What no keyframe can move any more: planes of a map to start from, and of keyframes that were folded, with
/// their own points and shapes. Whenever the map is made anew, it starts from them. Their ids are those of
/// the planes of the map that they are part of; several may be part of one.
class FoldedPlanes {
  public:
    FoldedPlanes(const MergeRules& rules, double max_extent_m) : planes_(rules, max_extent_m) {}

    void push_back(PlaneEstimate plane) { planes_.push_back(std::move(plane)); }

    /// Takes in what a keyframe, or a look, saw; its regions know their planes.
    void fold(int keyframe_id, const StoredKeyframe& keyframe, RegionJoiner& joiner,
              const FreeSpace& free_space);

    /// Planes of the map have new ids; those that are not in the list keep theirs.
    void rename(const std::map<int, int>& id_of);
    /// Those that have the same id become one, with the points and evidence of all.
    void unite();

    const std::vector<PlaneEstimate>& planes() const { return planes_.estimates(); }

  private:
    PlaneSet planes_;
};

}  // namespace planemap::map
