// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/outline_index.hpp"
#include "core/plane_map.hpp"
#include "evaluate/plane_raster.hpp"

namespace planemap::evaluation {

/// A plane of the map as it is asked for points and cells.
struct MapFace {
    int id = -1;
    Plane plane;
    Pose plane_from_world, world_from_plane;
    PlaneRaster raster;    ///< of the outline, cells of 2.5 cm
    OutlineIndex outline;  ///< in the plane's x and y
    double reach = 0;      ///< of the outline from its frame's origin, metres

    explicit MapFace(const MapPlane& map_plane);
    /// Whether the point, moved onto the plane, is on its outline.
    bool covers(const Eigen::Vector3d& p_world) const;
};

/// In the map's order.
std::vector<MapFace> faces_of(const PlaneMap& map);

/// The plane nearest to a point, and the signed distance to it, metres.
struct NearestFace {
    std::size_t index = 0;
    double distance_m = 0;
};

/// The nearest of those within reach (metres) whose outline covers the point; of two equally near ones the
/// later. Nothing if there is none.
std::optional<NearestFace> nearest_face(const std::vector<MapFace>& faces, const Eigen::Vector3d& p_world,
                                        double reach_m);

}  // namespace planemap::evaluation
