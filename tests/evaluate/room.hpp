// SPDX-License-Identifier: BSD-3-Clause
// True planes made by hand, and maps of them.
#pragma once

#include <cmath>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/geometry/box.hpp"
#include "evaluate/plane_judge.hpp"

namespace planemap::evaluation {

/// A rectangle in the world: x and y of its frame along the sides, z towards where it is seen from.
struct Face {
    std::string name;
    Eigen::Vector3d centre, normal, x;
    double half_x = 1, half_y = 1;

    Pose world_from_face() const {
        Pose pose = Pose::Identity();
        pose.linear() = plane_axes(normal.normalized(), x);
        pose.translation() = centre;
        return pose;
    }
    Outline outline() const {
        return {{{{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}}}};
    }
    Plane plane() const { return {normal.normalized(), -normal.normalized().dot(centre)}; }
};

inline TruePlane true_plane(const Face& face) {
    return {face.name, face.plane(), face.world_from_face(), rasterised(face.outline()), {}};
}

inline MapPlane map_plane(int id, const Face& face) {
    PlanarRegion region;
    region.plane = face.plane();
    region.box = {face.world_from_face(), {face.half_x, face.half_y, 0.01}};
    region.outline = face.outline();
    region.moments.count = 1000;
    return MapPlane(id, region, 3);
}

/// Floor, two walls that face each other, one at 56 deg, and a small shelf that does not count.
inline std::vector<Face> room() {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                          z = Eigen::Vector3d::UnitZ();
    const double angle = radians(56);
    return {{"floor", {0, 0, 0}, z, x, 2, 1.5},
            {"west wall", {-2, 0, 1.2}, x, y, 1.5, 1.2},
            {"east wall", {2, 0, 1.2}, -x, y, 1.5, 1.2},
            {"oblique wall", {0.5, 1.4, 1.2}, {-std::sin(angle), -std::cos(angle), 0}, z, 1.2, 0.5},
            {"shelf", {-1.8, 0, 0.8}, z, y, 0.4, 0.2}};
}

inline std::vector<TruePlane> truth_of(const std::vector<Face>& faces) {
    std::vector<TruePlane> truth;
    for (const Face& face : faces) truth.push_back(true_plane(face));
    return truth;
}

/// Ids 10, 11, ... in the faces' order.
inline PlaneMap map_of(const std::vector<Face>& faces) {
    PlaneMap map;
    for (const Face& face : faces)
        map.planes.push_back(map_plane(10 + static_cast<int>(map.planes.size()), face));
    return map;
}

}  // namespace planemap::evaluation
