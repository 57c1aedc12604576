// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/plane_map.hpp"
#include "map/inference.hpp"

namespace planemap::map {

/// How inferred parts are drawn.
struct InferenceRules {
    bool infers;         ///< else there are none
    double cell_m;       ///< of the raster
    double tolerance_m;  ///< by which an outline may leave the cells
    double least_m2;     ///< smaller parts, and smaller holes, are left out
};

/// What is inferred of the map's planes: found when the map is made anew, cut by what is seen since.
class InferredParts {
  public:
    explicit InferredParts(const InferenceRules& rules) : rules_(rules) {}

    /// What a map to start from holds stays, as long as no view says otherwise; views of before are gone.
    void start_from(const PlaneMap& map);
    /// The same of what is inferred now, before views go.
    void keep(const PlaneMap& map);

    /// Infers anew, see Inference, and gives the map what is found. `views`, the newest first.
    void infer(PlaneMap& map, const std::vector<Viewpoint>& views);
    /// After planes of the map changed their outlines or went; ascending ids.
    void update(PlaneMap& map, const std::vector<int>& changed) const;

    std::size_t memory_bytes() const;

  private:
    MapOutline outline_of(const MapPlane& plane) const;

    InferenceRules rules_;
    std::map<int, InferredCells> cells_;  ///< by plane
    std::map<int, PlanePart> told_;       ///< by plane: of views that are gone
};

}  // namespace planemap::map
