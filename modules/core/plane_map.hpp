// SPDX-License-Identifier: BSD-3-Clause
// The map of planes as it is kept and stored, small; sent it is packed once more, see messages/packed_map.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/packed_outline.hpp"
#include "core/region.hpp"

namespace planemap {

enum class PlaneLabel : std::int8_t {
    kUnknown = 0,
    kFloor = 1,
    kCeiling = 2,
    kWall = 3,
    kHorizontal = 4,
    kOther = 5,
    kVertical = 6
};

/// "floor", "ceiling", "wall", "horizontal", "vertical", "other" or "unknown".
const char* label_name(PlaneLabel label);

/// An outline in whole steps: 4 bytes a vertex.
struct MapOutline {
    float unit = 0.001f;               ///< metres a step
    std::vector<std::int16_t> packed;  ///< see pack()

    MapOutline() = default;
    /// As pack() rounds it, with its errors.
    explicit MapOutline(const Outline& outline);

    bool empty() const { return packed.empty(); }
    std::size_t ring_count() const;
    std::size_t vertex_count() const;
    /// As an Outline in the plane's x and y, metres.
    Outline rings() const;
    friend bool operator==(const MapOutline&, const MapOutline&) = default;
};

/// One plane of the map: 88 bytes and 4 an outline vertex, in single precision (which is a micrometre in a
/// building). Its frame has the origin at the centre of its box (the paper's B), z along the normal.
struct MapPlane {
    int id = -1;  ///< stable while the plane is the same
    PlaneLabel label = PlaneLabel::kUnknown;
    std::int16_t keyframes = 0;                              ///< that saw it; 32767: that many or more
    Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();       ///< unit, world, towards where it was seen from
    Eigen::Vector3f center = Eigen::Vector3f::Zero();        ///< of the box, on the plane, world, metres
    float angle = 0;                                         ///< of the box's x, about the normal; see axes()
    Eigen::Vector2f half_extents = Eigen::Vector2f::Zero();  ///< of the box along its x and y, metres
    float rms = 0;                                           ///< distance of the inliers to the plane, metres
    float inliers = 0;                                       ///< the paper's N
    float area = 0;                                          ///< of the outline, square metres
    MapOutline outline;                                      ///< in the plane's x and y

    MapPlane() = default;
    /// From a region in the world frame; the area is the outline's.
    MapPlane(int plane_id, const PlanarRegion& region_world, std::size_t keyframe_count);

    /// Lays the plane anew, its outline and box with it.
    void move_to(const Plane& plane_world);

    /// n.p + d = 0 in the world frame.
    Plane plane() const;
    /// Where the outline's x, y, 0 lies in the world.
    Pose world_from_plane() const;
    /// Box in the world frame, two standard deviations of the inliers thick on either side.
    Box box() const;
    /// Plane, box, outline, rms and moments.count; the other moments are zero.
    PlanarRegion region() const;

  private:
    void lay(const Plane& plane_world, const Eigen::Vector3d& box_center, const Eigen::Vector3d& box_x);
};

/// Distance from a point to the plane's outline, metres, world frame.
double distance(const MapPlane& plane, const Eigen::Vector3d& p_world);

/// Where two adjacent planes meet, cut to where both are. World frame, metres.
struct IntersectionLine {
    int plane_a = -1, plane_b = -1;  ///< ids, plane_a < plane_b
    Eigen::Vector3f from = Eigen::Vector3f::Zero(), to = Eigen::Vector3f::Zero();
};

/// Where three adjacent planes meet. World frame, metres.
struct IntersectionPoint {
    std::array<int, 3> planes{-1, -1, -1};  ///< ids, ascending
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
};

/// Parts of a floor, a ceiling or a wall that nobody saw: what stands before them hides them, and the plane
/// goes on beside it. They count in no area.
struct InferredRings {
    int plane = -1;      ///< id
    MapOutline outline;  ///< in the plane's x and y
};

/// The map: planes, and where they meet.
struct PlaneMap {
    std::int64_t utime = 0;                        ///< of the newest keyframe in it, microseconds
    int revision = 0;                              ///< of the trajectory it was built from
    int component = 0;                             ///< KeyframePose::component of what it is made of
    Eigen::Vector3f up = Eigen::Vector3f::Zero();  ///< unit, against gravity, world; zero: not known
    std::vector<MapPlane> planes;                  ///< ascending id
    std::vector<IntersectionLine> lines;
    std::vector<IntersectionPoint> points;
    std::vector<InferredRings> inferred;  ///< of the planes that have some, ascending id

    /// The plane with the id, or nullptr.
    const MapPlane* find(int id) const;
    /// What is inferred of the plane with the id, or nullptr.
    const MapOutline* inferred_of(int id) const;
};

/// Bytes that the map takes in memory, by capacity.
std::size_t memory_bytes(const PlaneMap& map);

}  // namespace planemap
