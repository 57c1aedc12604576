// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "map/folded_planes.hpp"
#include "map/free_space.hpp"
#include "map/keyframe_store.hpp"
#include "map/plane_ids.hpp"
#include "map/plane_set.hpp"
#include "map/region_joiner.hpp"

namespace planemap::map {

/// Makes all planes anew, see Planes::rebuild(): one object for one time, its steps in this order.
class Rebuild {
  public:
    /// Puts all keyframes where their poses say, and takes their regions out of their planes.
    Rebuild(KeyframeStore& store, FoldedPlanes& folded, PlaneIds& ids, const ObservationModel& model);

    /// Regions join the folded planes and make new ones, the weightiest first; then these are merged.
    /// `planes` is empty before.
    void join(PlaneSet& planes, RegionJoiner& joiner);
    /// The shapes: all regions, and then what all keyframes see past.
    void draw(PlaneSet& planes, const RegionJoiner& joiner, const FreeSpace& free_space, int threads) const;
    /// Ids of before for planes, regions and folded planes.
    void carry_over_ids(PlaneSet& planes);

  private:
    /// A region on its way from plane to plane.
    struct Entry {
        int keyframe_id;
        std::size_t region;
        StoredKeyframe* keyframe;
        int plane_before;
        std::size_t plane = PlaneSet::none();  ///< index of the plane it joined; none(): it is too far out
        Pose world_from_box = Pose::Identity();

        StoredRegion& stored_region() const { return keyframe->regions[region]; }
    };

    KeyframeStore& store_;
    FoldedPlanes& folded_;
    PlaneIds& ids_;
    int first_provisional_id_;
    std::vector<Entry> entries_;      ///< by keyframe and region
    std::vector<std::size_t> order_;  ///< of them, the weightiest first
};

}  // namespace planemap::map
