// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/plane_map.hpp"
#include "map/intersections.hpp"

namespace planemap::map {

/// Keeps the lines and points of a map up to date: only those of planes that changed are computed anew.
class MapIntersections {
  public:
    explicit MapIntersections(const AdjacencyRules& rules) : rules_(rules) {}

    /// Brings lines and points of the map to what its planes say, after those with the given ids, ascending,
    /// changed, came or went. Of the map's planes only those are read, and with the outlines that they then
    /// have. A line that comes within the gap of a point of its planes ends there.
    void update(PlaneMap& map, const std::vector<int>& changed_ids);

    /// The parts of the lines at which both planes end, see meeting_reach().
    const std::vector<IntersectionLine>& meetings() const { return meetings_; }
    /// The plane as of its last change; nullptr for an unknown id.
    const Plane* plane(int id) const;
    /// True if so many planes meet one another that the map does not hold all points where three do.
    bool left_out_points() const { return left_out_points_; }
    std::size_t memory_bytes() const;

  private:
    template <typename IsChanged>
    void add_lines(const std::vector<int>& changed_ids, IsChanged is_changed);
    template <typename IsChanged>
    void add_points(PlaneMap& map, IsChanged is_changed);

    void end_at_points(const std::vector<IntersectionPoint>& points,
                       std::vector<IntersectionLine>& lines) const;

    AdjacencyRules rules_;
    std::vector<IntersectionLine> lines_, reached_;  ///< as long as both planes are there
    std::vector<IntersectionLine> meetings_;
    std::map<int, PlaneShape> shapes_;  ///< of the map's planes, by id
    bool left_out_points_ = false;
};

}  // namespace planemap::map
