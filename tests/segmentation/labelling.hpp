// SPDX-License-Identifier: BSD-3-Clause
// A wall, labelled from some of its cells, for the tests of labelling and summing.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "segmentation/pixel_labels.hpp"
#include "segmentation/region_sums.hpp"
#include "segmentation/scene.hpp"
#include "segmentation/shape.hpp"

namespace planemap::segmentation {

inline const Plane kWall = scene::tilted(0.1, 0.2, {0, 0, 2});

inline InverseDepthPlane inverse_depth(const Plane& plane) {
    const Eigen::Vector3d n = -plane.normal / plane.d;
    return {n.x(), n.y(), n.z()};
}

/// Labels an image of one plane, of whose cells only those that `is_in` names are known to lie on it.
class Labelling {
  public:
    Labelling(const DepthImage& depth, const std::function<bool(int, int)>& is_in) {
        CellRules rules = sensor_rules(camera);
        rules.min_pixels = 32;
        rules.planarity_sigmas = 1.2;
        rules.grow_m = 0.01;
        rules.grow_angle_rad = 0.26;
        grid.reset(depth, rules);
        grid.fit();
        std::vector<std::uint16_t> label_of_cell;
        for (int i = 0; i < grid.size(); ++i)
            label_of_cell.push_back(is_in(grid.place(i).x, grid.place(i).y) ? 1 : 0);
        labeller.label(grid, label_of_cell, {inverse_depth(kWall)}, {0.015, 3, camera.noise});
        sums = summer.sum(grid, labeller, camera.noise);
        grid.take_labels(labels);
    }
    long labelled() const { return std::count(labels.pixels.begin(), labels.pixels.end(), 1); }

    CameraInfo camera = scene::camera(160, 120);
    CellGrid grid{best_cell_kernels()};
    PixelLabeller labeller;
    RegionSummer summer;
    std::vector<RegionSums> sums;
    Image<std::uint16_t> labels;
};

inline DepthImage wall() {
    return scene::render(scene::camera(160, 120), {scene::plane(kWall)});
}

}  // namespace planemap::segmentation
