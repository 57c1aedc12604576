// SPDX-License-Identifier: BSD-3-Clause
// The map in formats that other tools read. All functions are pure: the same map gives the same bytes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/plane_map.hpp"
#include "core/trajectory.hpp"

namespace planemap {

/// A colour that tells plane ids apart; the same in all exports.
Rgb plane_color(int id);

/// Ids of the keyframes that saw each plane, by the plane's id; both ascending.
using Sightings = std::map<int, std::vector<int>>;

/// JSON: planes (id, label, normal, d, inliers, rms, box corners, area, outline rings, keyframes),
/// intersection lines and points. World frame, metres; values are rounded to a micrometre (normals to 1e-9).
/// Values that are not finite become null.
std::string planes_json(const PlaneMap& map, const Sightings& sightings = {});

/// Binary little-endian PLY: each outline as triangles with the plane's colour and normal at its vertices.
/// World frame, metres.
std::string planes_ply(const PlaneMap& map);

/// Which way is up in the world, unit vector: the normal of the largest plane that is level within 30 deg
/// with how the camera was held (its image rows pointing down, on average); without such a plane, the
/// camera's average up; without a trajectory, the first camera's up (0, -1, 0).
Eigen::Vector3d guess_up(const PlaneMap& map, const Trajectory& trajectory);

/// SVG of the planes seen from above with their ids, walls as lines, the trajectory and a scale bar (the
/// paper's Fig. 4, left). The page is turned so that most walls run along its edges. Planes that face down
/// (ceilings) are left out.
std::string overhead_svg(const PlaneMap& map, const Trajectory& trajectory,
                         std::optional<Eigen::Vector3d> up = std::nullopt);

/// SVG of the planes in perspective from above a corner, shaded, with intersection lines and points and the
/// trajectory. Planes that face away from the viewer are left out, so that one looks into the rooms.
std::string perspective_svg(const PlaneMap& map, const Trajectory& trajectory,
                            std::optional<Eigen::Vector3d> up = std::nullopt);

}  // namespace planemap
