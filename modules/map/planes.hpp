// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "map/folded_planes.hpp"
#include "map/free_space.hpp"
#include "map/keyframe_store.hpp"
#include "map/map_losses.hpp"
#include "map/options.hpp"
#include "map/plane_ids.hpp"
#include "map/plane_set.hpp"
#include "map/region_joiner.hpp"
#include "map/surfaces.hpp"

namespace planemap::map {

/// The planes of the world, as estimates, and what keyframes do to them. StoredRegion::plane of every region
/// in the map is the id of the plane that it is part of, or -1 where it is too far out.
class Planes {
  public:
    explicit Planes(const MapOptions& options, PlaneIds ids = {});

    /// Takes a plane of a finished map; it is part of the map from the next rebuild() on.
    void start_from(PlaneEstimate plane);

    /// Gives the id to no new plane.
    void reserve_id(int id) { ids_.reserve(id); }

    /// Takes the regions of a keyframe, which has a pose, into the planes that they fit best or new ones;
    /// merges planes that have come to satisfy the rules, and carves what the keyframe sees past.
    void integrate(int keyframe_id, KeyframeStore& store, MapLosses& losses);
    /// The same of a look from near it; the store's.
    void integrate(int keyframe_id, StoredKeyframe& view, KeyframeStore& store, MapLosses& losses);
    /// So many more looks saw what a keyframe or a look saw.
    void see_again(const StoredKeyframe& view, int looks);
    /// Whether something came or went since the planes were derived that shows in an outline.
    bool has_changed() const;

    /// Keeps what the keyframe saw: it may go then.
    void fold(int keyframe_id, const StoredKeyframe& keyframe);

    /// Makes all planes anew from the folded ones and all keyframes with a pose: of their regions the
    /// weightiest first, so that neither the order in which keyframes came matters nor where they were
    /// before. A plane keeps its id, see PlaneIds::carry_over().
    void rebuild(KeyframeStore& store);

    std::vector<PlaneEstimate>& estimates() { return planes_.estimates(); }
    const std::vector<PlaneEstimate>& estimates() const { return planes_.estimates(); }
    const ObservationModel& model() const { return joiner_.model(); }
    std::size_t memory_bytes() const;

  private:
    void merge(const std::vector<std::size_t>& grown, KeyframeStore& store);
    void count_keyframes(const KeyframeStore& store);

    int threads_;
    std::optional<SurfaceRules> surfaces_;  ///< none: the paper's rules alone
    RegionJoiner joiner_;
    FreeSpace free_space_;
    PlaneSet planes_;
    FoldedPlanes folded_;
    PlaneIds ids_;
};

}  // namespace planemap::map
