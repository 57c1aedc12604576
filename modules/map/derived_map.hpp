// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/plane_map.hpp"
#include "map/inferred_parts.hpp"
#include "map/map_intersections.hpp"
#include "map/plane_derivation.hpp"
#include "map/told_up.hpp"

namespace planemap::map {

/// The map that others see, kept beside the estimates it is derived from: what hardly changed is left alone.
class DerivedMap {
  public:
    DerivedMap(const DerivationRules& derivation, const AdjacencyRules& adjacency,
               const InferenceRules& inference)
        : derivation_(derivation), adjacency_(adjacency), intersections_(adjacency), inferred_(inference) {}

    const PlaneMap& map() const { return map_; }
    bool left_out_points() const { return intersections_.left_out_points(); }
    /// Bytes of what is kept beside the map.
    std::size_t working_bytes() const { return intersections_.memory_bytes() + inferred_.memory_bytes(); }

    /// Goes on from a map in time, and with its up until up is found.
    void start_from(const PlaneMap& map);
    /// Gives the planes that are in an earlier map its labels.
    void take_labels(const PlaneMap& earlier);
    void set_revision(int revision) { map_.revision = revision; }
    void set_component(int component) { map_.component = component; }
    /// The newest keyframe in the map may be this one.
    void seen_at(std::int64_t utime);

    /// Derives planes anew that changed, with their intersections; and if any did, or more was told, finds up
    /// and labels all: by what was told, else by planes and motion, else by the map to start from. `poses`
    /// are world_from_camera of keyframes, by id. Estimates are marked as derived.
    void refresh(std::vector<PlaneEstimate>& estimates, const std::map<int, Pose>& poses,
                 const ToldUp& told = {});
    /// Infers hidden parts anew, see InferredParts; until the next time, refresh() cuts off what is seen.
    /// `views`, the newest first.
    void infer(const std::vector<Viewpoint>& views) { inferred_.infer(map_, views); }
    /// What is inferred now stays, though views that hide it go.
    void keep_inferred() { inferred_.keep(map_); }
    /// Where map().up is from, or why it is not known: a clause.
    const std::string& why_up() const { return why_up_; }

  private:
    void label(const std::map<int, Pose>& poses, const ToldUp& told);
    bool derive(PlaneEstimate& estimate, std::optional<MapPlane>& plane) const;
    std::map<int, std::vector<Meeting>> meetings() const;
    std::vector<int> end_at_lines(const std::vector<PlaneEstimate>& estimates,
                                  const std::vector<int>& changed);

    DerivationRules derivation_;
    AdjacencyRules adjacency_;
    MapIntersections intersections_;
    InferredParts inferred_;
    PlaneMap map_;
    std::map<int, std::vector<Meeting>> met_;  ///< where each plane's outline ends at others, as it was laid
    Eigen::Vector3f earlier_up_ = Eigen::Vector3f::Zero();  ///< of the map to start from; zero: not known
    std::string why_up_ = "there are no planes";
    // When the planes were labelled last:
    int told_revision_ = 0;       ///< of what was told
    std::size_t told_poses_ = 0;  ///< of keyframes where it was told
};

}  // namespace planemap::map
