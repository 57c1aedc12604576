// SPDX-License-Identifier: BSD-3-Clause
// What a robot asks of a map of planes.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "map/relation.hpp"

namespace planemap::map {

/// Answers about one map, in its world frame, metres. Building it unpacks all outlines (about half a
/// microsecond a plane); a question then takes some microseconds for a map of 300 planes, as boxes
/// are looked at before outlines. A map that changed needs a new one. Planes that are not finite or have no
/// outline are left out. A question with values that are not finite finds nothing. Safe to use from several
/// threads.
class MapQueries {
  public:
    struct Nearest {
        int id = -1;
        double distance = 0;
        Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the outline or inside it
    };
    struct Hit {
        int id = -1;
        double range = 0;  ///< metres from the ray's origin
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        bool from_front = true;  ///< hit on the side that the normal points to, the one that was seen
    };

    explicit MapQueries(const PlaneMap& map);

    /// The plane whose outline is nearest to the point; nothing if the map is empty or all are further than
    /// `within`.
    std::optional<Nearest> nearest(const Eigen::Vector3d& p_world,
                                   double within = std::numeric_limits<double>::infinity()) const;

    /// Ids of the planes of which a part lies in the box, ascending. Exact: holes and notches count.
    std::vector<int> touching(const Eigen::AlignedBox3d& box_world) const;

    /// The first plane that a ray meets, from either side, at most max_range from its origin; planes through
    /// the origin count, those along the ray do not. The direction's length does not matter.
    std::optional<Hit> cast(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                            double max_range = std::numeric_limits<double>::infinity()) const;

    /// Distance along map.up from a point on the floor to the first plane above it; infinity if there is
    /// none. What lies lower than `ignored` above the point is taken to be the floor itself. Nothing if up is
    /// not known.
    std::optional<double> free_height(const Eigen::Vector3d& p_floor_world, double ignored = 0.1) const;

    /// The smallest distance between the outlines of two planes: 0 where they touch or cross. Nothing if
    /// either is not in the map.
    std::optional<double> gap(int id_a, int id_b) const;

  private:
    struct Entry {
        int id;
        Pose plane_from_world, world_from_plane;
        Eigen::AlignedBox2d bounds;        ///< of the outline
        Eigen::AlignedBox3d bounds_world;  ///< of the outline
        Outline outline;
    };
    const Entry* find(int id) const;

    std::vector<Entry> entries_;  ///< ascending id
    Eigen::Vector3d up_;
};

}  // namespace planemap::map
