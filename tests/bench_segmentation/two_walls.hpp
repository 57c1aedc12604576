// SPDX-License-Identifier: BSD-3-Clause
// A scene with a known answer: two walls that meet in an edge in the middle of the image.
#pragma once

#include <cmath>

#include "bench_segmentation/truth.hpp"
#include "core/geometry/angle.hpp"
#include "segmentation/scene.hpp"

namespace planemap::bench {

namespace scene = segmentation::scene;

inline const Plane kWall1 = scene::tilted(0, 0.5, {0, 0, 2});
inline const Plane kWall2 = scene::tilted(0, -0.5, {0, 0, 2});
inline constexpr double kLeastPixels = 1000;

struct TwoWalls {
    CameraInfo camera = scene::camera();
    DepthImage depth = scene::render(camera, {scene::plane(kWall1), scene::plane(kWall2)});
    segmentation::Segmentation perfect;  ///< labels 1 and 2, without noise, so every pixel has one
    Truth truth;

    TwoWalls() {
        perfect.labels = Image<std::uint16_t>(depth.width, depth.height);
        for (int v = 0; v < depth.height; ++v) {
            for (int u = 0; u < depth.width; ++u) {
                const auto p = camera.depth.unproject(u, v, camera.metres(depth(u, v)));
                const bool first = std::abs(kWall1.signed_distance(p)) < std::abs(kWall2.signed_distance(p));
                perfect.labels(u, v) = first ? 1 : 2;
            }
        }
        for (const Plane& plane : {kWall1, kWall2}) perfect.regions.emplace_back().plane = plane;
        truth = make_truth(perfect.labels, {kWall1, kWall2}, depth, camera);
    }
};

/// The plane turned about an axis in it, through the point of it in the middle of the view.
inline Plane turned(const Plane& plane, double angle_deg) {
    const Eigen::Vector3d centre = Eigen::Vector3d::UnitZ() * (-plane.d / plane.normal.z());
    const Eigen::Vector3d axis = plane.normal.unitOrthogonal();
    const Eigen::Vector3d normal = Eigen::AngleAxisd(radians(angle_deg), axis) * plane.normal;
    return {normal, -normal.dot(centre)};
}

}  // namespace planemap::bench
