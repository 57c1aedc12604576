// SPDX-License-Identifier: BSD-3-Clause
// A small map to export.
#pragma once

#include "core/plane_map.hpp"
#include "core/trajectory.hpp"
#include "map/scene.hpp"

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

}  // namespace planemap::scene
