// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the OctoMap share: a small camera, its depth images and poses.
#pragma once

#include <memory>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "octomap/octomap_builder.hpp"

namespace planemap::test {

inline CameraInfo small_camera() {
    CameraInfo camera;
    camera.depth = camera.color = {64, 48, 52.5, 52.5, 31.5, 23.5};
    return camera;
}

/// A wall two metres ahead with a box before it and some invalid pixels.
inline DepthImage room(const CameraInfo& camera, std::uint16_t shift = 0) {
    DepthImage depth(camera.depth.width, camera.depth.height, static_cast<std::uint16_t>(2000 + shift));
    for (int v = 10; v < 30; ++v)
        for (int u = 20; u < 40; ++u) depth(u, v) = static_cast<std::uint16_t>(1200 + 5 * u);
    for (int u = 0; u < 20; ++u) depth(u, 3) = u % 2 ? 0 : 65535;
    return depth;
}

inline Pose pose(double x, double angle) {
    return make_pose({x, 0.02, -0.1},
                     Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.2, 1, 0.1).normalized())));
}

/// Keyframes 0, 1, 2 and so on.
inline KeyframeTrajectory trajectory(const std::vector<Pose>& poses) {
    KeyframeTrajectory result;
    for (const Pose& p : poses) result.keyframes.push_back({static_cast<int>(result.keyframes.size()), 0, p});
    return result;
}

/// Gives a keyframe's depth image to a builder; what OctomapBuilder::add() returns.
inline bool add_keyframe(octomap::OctomapBuilder& builder, int id, const DepthImage& depth,
                         const CameraInfo& camera, const Pose& world_from_camera) {
    return builder.add(id, std::make_shared<octomap::StoredScan>(depth, camera), world_from_camera,
                       {id, Pose::Identity()});
}

}  // namespace planemap::test
