// SPDX-License-Identifier: BSD-3-Clause
// How a region comes into a plane: the one place for keyframes that arrive, are folded, or are mapped anew.
#pragma once

#include <vector>

#include "map/free_space.hpp"
#include "map/observation.hpp"
#include "map/plane_ids.hpp"
#include "map/plane_set.hpp"

namespace planemap::map {

/// Takes regions into planes. It has scratch memory: threads use a copy each.
class RegionJoiner {
  public:
    /// Shapes of new planes have cells of that size.
    RegionJoiner(const ObservationModel& model, double cell_m) : model_(model), cell_m_(cell_m) {}

    const ObservationModel& model() const { return model_; }

    /// Takes a region's points and extent into estimates()[at], or, where `at` is PlaneSet::none(), into a
    /// new plane with the id. Returns where that is. The shape is draw()'s.
    std::size_t join(PlaneSet& planes, std::size_t at, int new_id, const Observation& seen);

    /// The same with the plane that the region fits best by the merging rules, a new one if there is none.
    std::size_t join_best(PlaneSet& planes, PlaneIds& ids, const Observation& seen);

    /// Draws a region, which `looks` more looks saw, into the shape of its plane; returns how many cells came
    /// to it. Blocks of cells that were never seen before are added to `fresh`.
    int draw(PlaneEstimate& plane, const Pose& world_from_box, const StoredRegion& region,
             const StoredKeyframe& keyframe, int looks, std::vector<EvidenceBlock>* fresh = nullptr);
    /// For a shape that is made anew: adds the region's support, and returns its cells with when they were
    /// seen.
    SeenCells draw_support(PlaneEstimate& plane, const Pose& world_from_box, const StoredRegion& region,
                           const StoredKeyframe& keyframe);

  private:
    ObservationModel model_;
    double cell_m_;
    void outline_in_grid(PlaneEstimate& plane, const Pose& world_from_box, const StoredRegion& region,
                         const StoredKeyframe& keyframe);

    FlatPolygon polygon_;  ///< scratch
};

}  // namespace planemap::map
