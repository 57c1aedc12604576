// SPDX-License-Identifier: BSD-3-Clause
// The map's options as each of its parts takes them: a default stands in MapOptions and nowhere else.
#pragma once

#include <optional>

#include "map/inferred_parts.hpp"
#include "map/intersections.hpp"
#include "map/merging.hpp"
#include "map/observation.hpp"
#include "map/options.hpp"
#include "map/plane_derivation.hpp"
#include "map/surfaces.hpp"

namespace planemap::map {

/// Which regions are one plane, by the paper's rules.
MergeRules merge_rules(const MapOptions& options);
/// And which planes are one surface; nothing where the paper's rules alone count.
std::optional<SurfaceRules> surface_rules(const MapOptions& options);
/// What a view counts for.
ObservationModel observation_model(const MapOptions& options);
/// What of the planes is shown, and with what outline.
DerivationRules derivation_rules(const MapOptions& options);
/// Which of them meet.
AdjacencyRules adjacency_rules(const MapOptions& options);
/// What is inferred of what nobody saw.
InferenceRules inference_rules(const MapOptions& options);

}  // namespace planemap::map
