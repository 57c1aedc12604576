// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "map/folded_planes.hpp"
#include "map/free_space.hpp"
#include "map/keyframe_store.hpp"
#include "map/plane_ids.hpp"
#include "map/plane_set.hpp"
#include "map/region_joiner.hpp"
#include "map/surfaces.hpp"

namespace planemap::map {

/// Of all keyframes with a pose and their looks, the newest first.
std::vector<Viewpoint> viewpoints(const KeyframeStore& store);

/// Makes all planes anew, see Planes::rebuild(): one object for one time, its steps in this order.
class Rebuild {
  public:
    /// Puts all keyframes where their poses say, and takes their regions out of their planes.
    Rebuild(KeyframeStore& store, FoldedPlanes& folded, PlaneIds& ids, const ObservationModel& model);

    /// Regions join the folded planes and make new ones, the weightiest first; then these are merged, and
    /// with rules of surfaces, what says one surface twice is united, and regions are asked again whether
    /// they belong (reassign_strays()). `planes` is empty before.
    void join(PlaneSet& planes, RegionJoiner& joiner, const std::optional<SurfaceRules>& surfaces);
    /// The shapes: what all keyframes and looks see, and see past, in order of time.
    void draw(PlaneSet& planes, const RegionJoiner& joiner, const FreeSpace& free_space, int threads) const;
    /// Ids of before for planes, regions and folded planes.
    void carry_over_ids(PlaneSet& planes);

  private:
    void draw(PlaneEstimate& plane, const std::vector<const SeenRegion*>& seen, RegionJoiner& joiner,
              const FreeSpace& free_space, const std::vector<Viewpoint>& viewpoints) const;
    void rename_folded(const PlaneSet& planes, const std::vector<std::size_t>& now);

    KeyframeStore& store_;
    FoldedPlanes& folded_;
    PlaneIds& ids_;
    int first_provisional_id_;
    std::vector<SeenRegion> entries_;  ///< by keyframe, view and region; none() as plane: it is too far out
    std::vector<StoredRegion*> regions_;  ///< of the entries
    std::vector<int> planes_before_;      ///< of the entries
    std::vector<std::size_t> order_;      ///< of them, the weightiest first
};

}  // namespace planemap::map
