// SPDX-License-Identifier: BSD-3-Clause
// The map in formats that other tools read. All functions are pure: the same map gives the same bytes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/cloud_point.hpp"
#include "core/plane_map.hpp"
#include "core/trajectory.hpp"

namespace planemap::exports {

/// Ids of the keyframes that saw each plane, by the plane's id; both ascending.
using Sightings = std::map<int, std::vector<int>>;

/// JSON: up, planes (id, label, normal, d, inliers, rms, box corners, area, outline rings, keyframes),
/// intersection lines and points. World frame, metres; values are rounded to a micrometre (normals to 1e-9).
/// Values that are not finite become null, and so do up and the keyframes that saw a plane when they are not
/// known.
std::string planes_json(const PlaneMap& map, const std::optional<Sightings>& sightings = std::nullopt);

// All others leave out planes that are not finite or have no outline.

// The three that follow stand upright: the world is turned so that up is map.up, or, while that is not known,
// against the first camera's y (without poses: the world's), and most walls run along x. Each file says so
// and by which rotation, and carries the trajectory as a line of points at least a centimetre apart.

/// Binary little-endian PLY, z up as survey and point cloud programs have it: each outline as triangles with
/// the plane's colour and normal at its vertices; the trajectory as further vertices, joined by edges
/// (element edge). Comments tell ids, labels and numbers of faces in their order. Metres.
std::string planes_ply(const PlaneMap& map, const Trajectory& trajectory);

/// Binary little-endian PLY of points: x, y, z (float, metres), red, green, blue (uchar) and plane (int; the
/// id, -1: none), in the points' own frame, which the comment names.
std::string points_ply(const std::vector<CloudPoint>& points, const std::string& comment);

/// Wavefront OBJ, y up as its readers take it: an object a plane, named plane_<id>_<label>, of triangles with
/// the plane's normal; its material plane_<id> is in the MTL file of planes_mtl(), which goes beside it under
/// the given name. The object trajectory is a line. Metres, rounded to 0.01 mm.
std::string planes_obj(const PlaneMap& map, const Trajectory& trajectory,
                       const std::string& mtl_file = "planes.mtl");
std::string planes_mtl(const PlaneMap& map);

/// glTF 2.0 in its binary form (.glb), which is one file, opens in viewers and browsers without another, and
/// is smaller than JSON with the buffers inside. A node with a mesh a plane, named plane_<id>_<label>, id,
/// label and area in its extras, its colour as a double-sided material; a node trajectory with a line strip.
/// Vertices are in the world frame, metres; the root node turns it so that y is up, and says how in its
/// extras.
std::string planes_glb(const PlaneMap& map, const Trajectory& trajectory);

/// Binary PCD 0.7 as the Point Cloud Library has it: x, y, z (metres), rgb, and label (the plane's id,
/// 4294967295: none), in the points' own frame, which the comment names.
std::string points_pcd(const std::vector<CloudPoint>& points, const std::string& comment);

/// GeoJSON of the floor plan: what is upright (walls, sides of furniture) as lines, the rest (floors, tables,
/// slopes) as polygons with holes, each with label, height range and area, and the trajectory as a line;
/// ceilings and planes without a label are left out. Coordinates are not degrees but metres in a local level
/// frame, x along most walls; the file says so and how the world is turned into it. Heights are above the
/// largest floor, without one above the world's origin. Rounded to a millimetre.
std::string floor_plan_geojson(const PlaneMap& map, const Trajectory& trajectory);

/// SVG of the planes seen from above with their ids, upright ones as lines, the trajectory and a scale bar
/// (the paper's Fig. 4, left). The page is turned so that most walls run along its edges. Colours tell the
/// labels; the legend beside the drawing counts all planes of the map, also those that are not drawn, as they
/// face down (ceilings), and small ones are without number. Tooltips tell id, label and area. Up is map.up;
/// while that is not known, how the camera was held on average.
std::string overhead_svg(const PlaneMap& map, const Trajectory& trajectory);

/// SVG of the planes in perspective from above a corner, shaded, with intersection lines and points, the
/// trajectory, and a bar that shows the scale at the front edge of the floor. Planes that face away from the
/// viewer are left out, so that one looks into the rooms. Ids and labels show as tooltips. Up is as for
/// overhead_svg().
std::string perspective_svg(const PlaneMap& map, const Trajectory& trajectory);

}  // namespace planemap::exports
