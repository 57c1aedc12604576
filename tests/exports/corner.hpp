// SPDX-License-Identifier: BSD-3-Clause
// A small map to export.
#pragma once

#include <cstdio>
#include <string>

#include "core/plane_map.hpp"
#include "core/scene.hpp"
#include "core/trajectory.hpp"

namespace planemap::scene {

inline MapPlane plane_of(int id, const Rectangle& rectangle) {
    return {id, region_of(rectangle, Pose::Identity()), 2};
}

/// A floor, a wall with a window and a ceiling; z up.
inline PlaneMap corner() {
    PlaneMap map;
    map.utime = 42;
    map.planes = {
        plane_of(1, {facing({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 1, 1, {}}),
        plane_of(3, {facing({1, 0, 1}, {-1, 0, 0}, {0, 1, 0}), 1, 1, {rectangle_ring(-0.3, -0.3, 0.2, 0.4)}}),
        plane_of(12, {facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}), 1, 1, {}})};
    map.up = Eigen::Vector3f::UnitZ();
    map.planes[0].label = PlaneLabel::kFloor;
    map.planes[1].label = PlaneLabel::kWall;
    map.planes[2].label = PlaneLabel::kCeiling;
    map.lines = {{1, 3, {1, -1, 0}, {1, 1, 0}}};
    map.points = {{{1, 3, 12}, {1, 1, 0}}};
    return map;
}

/// Held upright, along x.
inline Trajectory walk() {
    Trajectory trajectory;
    for (int i = 0; i < 5; ++i) {
        // Looking along world y, held upright: image rows point down, along -z.
        Pose pose = Pose::Identity();
        pose.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
        pose.translation() = Eigen::Vector3d(-0.5 + 0.2 * i, 0, 1);
        trajectory.push_back({i, pose});
    }
    return trajectory;
}

/// The rotation that an upright file says of itself: "position = R * p_world with R, row by row: ...".
inline Eigen::Matrix3d said_rotation(const std::string& file) {
    const std::string lead = "R, row by row: ";
    const auto at = file.find(lead);
    Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
    if (at == std::string::npos) return r;
    std::sscanf(file.c_str() + at + lead.size(), "%lf %lf %lf; %lf %lf %lf; %lf %lf %lf", &r(0, 0), &r(0, 1),
                &r(0, 2), &r(1, 0), &r(1, 1), &r(1, 2), &r(2, 0), &r(2, 1), &r(2, 2));
    return r;
}

/// Maps whose up lies in several directions, and one that does not know it, with a walk.
inline std::vector<PlaneMap> maps_of_several_ups() {
    std::vector<PlaneMap> maps;
    for (const Eigen::Vector3f& up : {Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(0.6f, -0.8f, 0),
                                      Eigen::Vector3f(0, -1, 0), Eigen::Vector3f(0, 0, 0)}) {
        maps.push_back(corner());
        maps.back().up = up;
    }
    return maps;
}

/// Up as the upright files take it: the map's, else against the first camera's y.
inline Eigen::Vector3d expected_up(const PlaneMap& map, const Trajectory& trajectory) {
    if (!map.up.isZero()) return map.up.cast<double>().normalized();
    return -trajectory.front().world_from_camera.linear().col(1);
}

}  // namespace planemap::scene
