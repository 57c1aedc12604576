// SPDX-License-Identifier: BSD-3-Clause
#include "measure/measures.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "map/queries.hpp"

namespace planemap {

namespace {

constexpr std::size_t kMostPlanes = 1000;  // whose every pair is measured

/// "0, 1, 4, ... 12 planes in all".
std::string ids_text(const PlaneMap& map) {
    constexpr std::size_t kShown = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(kShown, map.planes.size()); ++i)
        text += (i == 0 ? "" : ", ") + std::to_string(map.planes[i].id);
    if (map.planes.empty()) return "no planes";
    return map.planes.size() > kShown ? text + " ... " + std::to_string(map.planes.back().id) : text;
}

const MapPlane& plane_of(const PlaneMap& map, int id) {
    const MapPlane* plane = map.find(id);
    if (plane == nullptr)
        throw std::invalid_argument("no plane " + std::to_string(id) + " in the map, which has " +
                                    ids_text(map));
    return *plane;
}

}  // namespace

const char* const kCertainty =
    "sigmas are one standard deviation, from each plane's scatter (rms), over the keyframes that saw it as "
    "independent looks, and its extent. They hold neither a drift of the trajectory from one plane to the "
    "other "
    "nor depth that is off everywhere: no map tells those.";

std::vector<Measure> measures_of_rooms(const PlaneMap& map) {
    std::vector<Measure> measures;
    for (const map::RoomSpan& span : map::room_spans(map))
        measures.push_back({map::kind_name(span.kind), span.a, span.b, span.relation, std::nullopt});
    return measures;
}

std::vector<Measure> measures_of(const PlaneMap& map, const std::vector<int>& ids) {
    if (ids.size() < 2) throw std::invalid_argument("a distance is between two planes: give two ids or more");
    std::set<int> seen;
    for (const int id : ids) {
        plane_of(map, id);
        if (!seen.insert(id).second)
            throw std::invalid_argument("plane " + std::to_string(id) + " is given twice");
    }
    const map::MapQueries queries(map);
    std::vector<Measure> measures;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        for (std::size_t j = i + 1; j < ids.size(); ++j) {
            measures.push_back({"pair", ids[i], ids[j],
                                map::relation(plane_of(map, ids[i]), plane_of(map, ids[j])),
                                queries.gap(ids[i], ids[j])});
        }
    }
    return measures;
}

std::vector<Measure> measures_of_all(const PlaneMap& map) {
    if (map.planes.size() > kMostPlanes)
        throw std::invalid_argument("the map has " + std::to_string(map.planes.size()) +
                                    " planes; every pair is for at most " + std::to_string(kMostPlanes) +
                                    ": give ids");
    std::vector<Measure> measures;
    for (std::size_t i = 0; i < map.planes.size(); ++i) {
        for (std::size_t j = i + 1; j < map.planes.size(); ++j) {
            measures.push_back({"pair", map.planes[i].id, map.planes[j].id,
                                map::relation(map.planes[i], map.planes[j]), std::nullopt});
        }
    }
    return measures;
}

}  // namespace planemap
