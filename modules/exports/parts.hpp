// SPDX-License-Identifier: BSD-3-Clause
// What the exports share.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/id_color.hpp"
#include "core/image.hpp"
#include "core/plane_map.hpp"
#include "core/trajectory.hpp"

namespace planemap::exports {

/// A number with a fixed number of decimals, a point whatever the locale, and no negative zero.
std::string fixed(double value, int decimals);

/// "plane_3_wall".
std::string plane_name(const MapPlane& plane);

/// The planes that can be drawn: all values finite, an outline that is not empty.
std::vector<const MapPlane*> drawable_planes(const PlaneMap& map);

/// The planes of which parts are inferred, with these as their outlines.
std::vector<MapPlane> inferred_planes(const PlaneMap& map);

/// Area of what is inferred of the plane with the id, square metres; 0 where nothing is.
double inferred_area(const PlaneMap& map, int id);

/// A border, counter-clockwise, and its holes, clockwise, as RFC 7946 and OGC's simple features have it.
using Part = std::vector<Ring>;

/// The separate parts of an outline, whose rings are even-odd and do not cross; rings of fewer than three
/// vertices are left out.
std::vector<Part> parts_of(const std::vector<Ring>& rings);

/// The outline's rings in the world frame.
std::vector<std::vector<Eigen::Vector3d>> world_rings(const MapPlane& plane);

/// The outline as triangles, in the world frame, counter-clockwise about the normal.
struct PlaneMesh {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<int, 3>> triangles;
};
PlaneMesh mesh_of(const MapPlane& plane);

/// Up in the world, a unit vector: map.up if that is known, otherwise how the camera was held on average (its
/// image rows pointing down), without poses the first camera's up (0, -1, 0).
Eigen::Vector3d up_of(const PlaneMap& map, const Trajectory& trajectory);

/// World to a level frame: z is up, x runs along most walls. A rotation.
Eigen::Matrix3d level_from_world(const PlaneMap& map, const Eigen::Vector3d& up);

/// How the files in three dimensions stand: turned about the world's origin so that up is up.
struct UprightFrame {
    Eigen::Matrix3d level_from_world;  ///< to z up, x along most walls
    bool up_is_known = false;          ///< by the map; otherwise up is against the first camera's y

    /// To y up, x along most walls.
    Eigen::Matrix3d y_up_from_world() const;
    /// What a file says of its frame, a line each; the rotation is one of the two above, and `up` its axis.
    std::vector<std::string> notes(const Eigen::Matrix3d& file_from_world, char up) const;
};
UprightFrame upright_frame(const PlaneMap& map, const Trajectory& trajectory);

/// The way of the camera in the world frame: finite positions, each at least a centimetre from the one
/// before, and the last.
std::vector<Eigen::Vector3d> walked(const Trajectory& trajectory);
constexpr Rgb kTrajectoryColor{179, 20, 42};

/// Where an upright plane stands, seen from above: pieces in x and y of the level frame. Parts above one
/// another are one piece.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> footprint(const MapPlane& plane,
                                                                   const Eigen::Matrix3d& level_from_world);

}  // namespace planemap::exports
