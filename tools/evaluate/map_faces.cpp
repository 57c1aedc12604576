// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map_faces.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::evaluation {

MapFace::MapFace(const MapPlane& map_plane)
    : id(map_plane.id),
      plane(map_plane.plane()),
      plane_from_world(map_plane.world_from_plane().inverse(Eigen::Isometry)),
      world_from_plane(map_plane.world_from_plane()),
      raster(rasterised(map_plane.outline.rings())),
      outline(map_plane.outline.rings()) {
    const Outline rings = map_plane.outline.rings();
    for (const Ring& ring : rings.rings)
        for (const Eigen::Vector2d& v : ring) reach = std::max(reach, v.norm());
}

bool MapFace::covers(const Eigen::Vector3d& p_world) const {
    const Eigen::Vector2d p = (plane_from_world * p_world).head<2>();
    return p.norm() <= reach && outline.contains(p);
}

std::vector<MapFace> faces_of(const PlaneMap& map) {
    return {map.planes.begin(), map.planes.end()};
}

std::optional<NearestFace> nearest_face(const std::vector<MapFace>& faces, const Eigen::Vector3d& p_world,
                                        double reach_m) {
    std::optional<NearestFace> best;
    double nearest = reach_m;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const double distance = faces[i].plane.signed_distance(p_world);
        if (std::abs(distance) > nearest || !faces[i].covers(p_world)) continue;
        nearest = std::abs(distance);
        best = {i, distance};
    }
    return best;
}

}  // namespace planemap::evaluation
