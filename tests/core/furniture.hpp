// SPDX-License-Identifier: BSD-3-Clause
// Rooms as maps, z up, and cameras that look around in them.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/plane_map.hpp"
#include "core/scene.hpp"

namespace planemap::scene {

constexpr double kDegree = radians(1);

/// A camera at a position that looks along `yaw` (about z, from x), `pitch` downwards.
inline Pose looking(const Eigen::Vector3d& position, double yaw, double pitch) {
    Pose pose = Pose::Identity();
    const Eigen::Vector3d ahead(std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch),
                                -std::sin(pitch));
    const Eigen::Vector3d right(std::sin(yaw), -std::cos(yaw), 0);
    pose.linear() << right, ahead.cross(right), ahead;
    pose.translation() = position;
    return pose;
}

/// Cameras that turn about once while they go round in a circle of 1 m.
inline std::vector<Pose> looking_around(double height, double pitch) {
    std::vector<Pose> poses;
    for (int i = 0; i < 24; ++i) {
        const double yaw = i * 15 * kDegree;
        poses.push_back(looking({std::cos(yaw), std::sin(yaw), height}, yaw + 0.7, pitch));
    }
    return poses;
}

/// A map of rectangles moved into another world; the planes' ids are their places in the list.
inline PlaneMap map_of(const std::vector<Rectangle>& rectangles,
                       const Pose& world_from_room = Pose::Identity()) {
    PlaneMap map;
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        Rectangle moved = rectangles[i];
        moved.world_from_face = world_from_room * moved.world_from_face;
        map.planes.emplace_back(static_cast<int>(i), region_of(moved, Pose::Identity(), 0.1), 3);
    }
    return map;
}

/// Level, facing up, 2 half_x by 2 half_y.
inline Rectangle level(double x, double y, double z, double half_x, double half_y) {
    return {facing({x, y, z}, {0, 0, 1}, {1, 0, 0}), half_x, half_y};
}

inline Rectangle facing_down(Rectangle r) {
    r.world_from_face = r.world_from_face * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
    return r;
}

/// Upright, facing along `yaw`; the middle of its foot is at x, y, z.
inline Rectangle upright(double x, double y, double z, double yaw, double width, double height) {
    return {facing({x, y, z + height / 2}, {std::cos(yaw), std::sin(yaw), 0}, {0, 0, 1}), height / 2,
            width / 2};
}

/// Four walls of a room of 2 half_x by 2 half_y, seen from inside.
inline std::vector<Rectangle> walls(double half_x, double half_y, double z = 0, double height = 2.5) {
    return {upright(-half_x, 0, z, 0, 2 * half_y, height),
            upright(half_x, 0, z, std::numbers::pi, 2 * half_y, height),
            upright(0, -half_y, z, std::numbers::pi / 2, 2 * half_x, height),
            upright(0, half_y, z, -std::numbers::pi / 2, 2 * half_x, height)};
}

inline std::vector<Pose> moved(const Pose& world_from_room, std::vector<Pose> poses) {
    for (Pose& pose : poses) pose = world_from_room * pose;
    return poses;
}

}  // namespace planemap::scene
