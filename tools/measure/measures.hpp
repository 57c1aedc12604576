// SPDX-License-Identifier: BSD-3-Clause
// What planemap-measure says of a map.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "map/relation.hpp"

namespace planemap {

/// Two planes of a map.
struct Measure {
    std::string kind;  ///< "pair", or kind_name() of a RoomSpan
    int a = -1, b = -1;
    map::PlaneRelation relation;
    std::optional<double> gap;  ///< between the outlines, metres; only where pairs were asked for by ids
};

/// Across the rooms: map::room_spans().
std::vector<Measure> measures_of_rooms(const PlaneMap& map);

/// Every pair of these planes, in their order. Throws std::invalid_argument for fewer than two ids, one that
/// stands twice, and one that is not in the map.
std::vector<Measure> measures_of(const PlaneMap& map, const std::vector<int>& ids);

/// Every pair of the map. Throws std::invalid_argument for a map of more than 1000 planes: that is half a
/// million.
std::vector<Measure> measures_of_all(const PlaneMap& map);

/// Where sigmas come from and what they leave out, in two sentences.
extern const char* const kCertainty;

/// The planes of a map and measures of them, as text for people, as JSON and as CSV. What is not known is
/// said to be unknown, null and empty.
std::string measures_text(const PlaneMap& map, const std::vector<Measure>& measures, bool with_planes);
nlohmann::ordered_json measures_json(const PlaneMap& map, const std::vector<Measure>& measures);
std::string measures_csv(const PlaneMap& map, const std::vector<Measure>& measures);

}  // namespace planemap
