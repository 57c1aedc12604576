// SPDX-License-Identifier: BSD-3-Clause
// A depth image of a floor and a wall, with a window in the wall, and its camera.
#pragma once

#include "segmentation/scene.hpp"

namespace planemap {

namespace scene = segmentation::scene;

inline CameraInfo small_camera() {
    return scene::camera(320, 240);
}

inline DepthImage small_depth() {
    const auto beside_window = [](const Eigen::Vector3d& p) {
        return std::abs(p.x()) > 0.25 || p.y() < -0.5 || p.y() > 0;
    };
    return scene::render(small_camera(),
                         {scene::plane({{0, -1, 0}, 0.6}), scene::plane({{0, 0, -1}, 2}, beside_window)});
}

/// camera.json of small_camera().
inline std::string small_camera_json() {
    return R"({"depth_camera": {"width": 320, "height": 240, "fx": 277.12, "fy": 277.12, "cx": 159.5, )"
           R"("cy": 119.5}, "depth_units_per_metre": 1000})";
}

}  // namespace planemap
