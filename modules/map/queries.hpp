// SPDX-License-Identifier: BSD-3-Clause
// What a robot asks of a map of planes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/plane_map.hpp"
#include "core/seen_space.hpp"
#include "map/relation.hpp"

namespace planemap::map {

/// What is known of a place.
enum class Place : std::uint8_t {
    kUnknown,   ///< nobody saw it: it may be free, or hold anything
    kFree,      ///< it was seen to be empty
    kOccupied,  ///< a plane is there
};

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

    /// What a ray from its origin meets.
    struct Stretch {
        double free = 0;              ///< metres along the ray that are known to be free
        Place end = Place::kUnknown;  ///< what is behind these; kFree: nothing up to the largest range
        /// The first plane within the largest range, also one behind what nobody saw.
        std::optional<Hit> hit;
    };

    /// Without what was seen to be empty (of a file: read_seen_space()), only the space right before planes
    /// is known to be free.
    explicit MapQueries(const PlaneMap& map, SeenSpace seen = {});

    /// Occupied within 5 cm of a plane's outline. Free in a voxel of 10 cm that was seen to be empty, and up
    /// to 25 cm before the outline of a plane, which was seen through that. Nothing is said of what is no
    /// plane but that it is not free: see SeenThrough.
    Place state_at(const Eigen::Vector3d& p_world) const;

    /// How far a ray is free, which takes some ten microseconds. Nothing for a direction of no length or
    /// values that are not finite; max_range may be infinite.
    std::optional<Stretch> look_along(const Eigen::Vector3d& origin_world,
                                      const Eigen::Vector3d& direction_world,
                                      double max_range = std::numeric_limits<double>::infinity()) const;

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

    /// look_along() map.up from a point on the floor: as far as space is free above it, whether a plane or
    /// what nobody saw ends that, and the first plane above it. What lies lower than `ignored` above the
    /// point is taken to be the floor itself, and free. Nothing if up is not known.
    std::optional<Stretch> free_height(const Eigen::Vector3d& p_floor_world, double ignored = 0.1) const;

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
    bool is_before_plane(const Eigen::Vector3d& p_world) const;

    std::vector<Entry> entries_;  ///< ascending id
    SeenSpace seen_;
    Eigen::Vector3d up_;
};

}  // namespace planemap::map
