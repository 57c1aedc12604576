// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "map/map_intersections.hpp"
#include "map/plane_derivation.hpp"

namespace planemap::map {

/// The map that others see, kept beside the estimates it is derived from: what hardly changed is left alone.
class DerivedMap {
  public:
    DerivedMap(const DerivationRules& derivation, const AdjacencyRules& adjacency)
        : derivation_(derivation), intersections_(adjacency) {}

    const PlaneMap& map() const { return map_; }
    bool left_out_points() const { return intersections_.left_out_points(); }
    /// Bytes of what is kept beside the map.
    std::size_t working_bytes() const { return intersections_.memory_bytes(); }

    /// Goes on from a map in time, and with its up until up is found.
    void start_from(const PlaneMap& map);
    /// Gives the planes that are in an earlier map its labels.
    void take_labels(const PlaneMap& earlier);
    void set_revision(int revision) { map_.revision = revision; }
    /// The newest keyframe in the map may be this one.
    void seen_at(std::int64_t utime);

    /// Derives planes anew that changed, with their intersections; and if any did, finds up and labels all.
    /// `poses` are world_from_camera of keyframes, by id. Estimates are marked as derived.
    void refresh(std::vector<PlaneEstimate>& estimates, const std::map<int, Pose>& poses);

  private:
    bool derive(PlaneEstimate& estimate, std::optional<MapPlane>& plane) const;

    DerivationRules derivation_;
    MapIntersections intersections_;
    PlaneMap map_;
};

}  // namespace planemap::map
