// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/crossing.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation {

/// How far a segmentation's outlines reach beyond the readings of their regions.
struct Reach {
    int vertices = 0;
    int crossing = 0;  ///< outlines that cross themselves
    double worst = 0;  ///< of a vertex to the region's nearest reading, within the plane, in cells there
};

inline Reach reach_of(const Segmentation& segmentation, const DepthImage& depth, const CameraInfo& camera) {
    Reach reach;
    const double cell_px = std::max(1, (depth.width + 80) / 160);
    for (std::size_t r = 0; r < segmentation.regions.size(); ++r) {
        const PlanarRegion& region = segmentation.regions[r];
        // On the plane, with the size of a cell there.
        std::vector<std::pair<Eigen::Vector2d, double>> readings;
        const Pose box_from_camera = region.box.frame_from_box.inverse();
        for (int v = 0; v < depth.height; ++v) {
            for (int u = 0; u < depth.width; ++u) {
                if (segmentation.labels(u, v) != r + 1) continue;
                const Eigen::Vector3d p = camera.depth.unproject(u, v, camera.metres(depth(u, v)));
                readings.emplace_back((box_from_camera * p).head<2>(), cell_px * p.z() / camera.depth.fx);
            }
        }
        for (const Ring& ring : region.outline.rings) {
            for (const Eigen::Vector2d& vertex : ring) {
                double nearest = 1e9;
                for (const auto& [at, cell] : readings)
                    nearest = std::min(nearest, (at - vertex).norm() / cell);
                ++reach.vertices;
                reach.worst = std::max(reach.worst, nearest);
            }
        }
        reach.crossing += rings_cross(region.outline);
    }
    return reach;
}

}  // namespace planemap::segmentation
