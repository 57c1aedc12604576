// SPDX-License-Identifier: BSD-3-Clause
// A rendered corner of a room with a texture that is a function of place, for odometry tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/moments.hpp"
#include "core/geometry/plane.hpp"
#include "core/image.hpp"
#include "core/region.hpp"

namespace planemap::odometry {

struct RenderedFrame {
    GrayImage gray;
    DepthImage depth;
};

inline CameraInfo room_camera() {
    CameraInfo camera;
    camera.color = camera.depth = {320, 240, 260, 260, 159.5, 119.5};
    camera.depth_units_per_metre = 5000;
    return camera;
}

/// Value noise in [0, 1] on a grid of `cell` metres.
inline double noise_at(const Eigen::Vector3d& p, double cell, std::uint32_t seed) {
    const Eigen::Vector3d q = p / cell, base = q.array().floor();
    const Eigen::Vector3d f = q - base;
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
        std::uint32_t h = seed;
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const int bit = (corner >> axis) & 1;
            const auto index = static_cast<std::uint32_t>(static_cast<int>(base[axis]) + bit + 1000);
            h = (h ^ index) * 2654435761u;
            h ^= h >> 15;
            weight *= bit ? f[axis] : 1 - f[axis];
        }
        value += weight * static_cast<double>(h & 0xffff) / 65535.0;
    }
    return value;
}

/// The planes of the room in its own frame, normals inwards: back wall, floor, left and right wall, ceiling.
inline std::vector<Plane> room_planes() {
    return {{{0, 0, -1}, 3.0}, {{0, -1, 0}, 0.9}, {{1, 0, 0}, 1.1}, {{-1, 0, 0}, 1.4}, {{0, 1, 0}, 1.4}};
}

/// The view at room_from_camera. With `textured` false every surface has one brightness.
inline RenderedFrame render_room(const CameraInfo& info, const Pose& room_from_camera, bool textured = true,
                                 const std::vector<Plane>& planes = room_planes()) {
    const PinholeCamera& camera = info.color;
    RenderedFrame frame{GrayImage(camera.width, camera.height, 0),
                        DepthImage(camera.width, camera.height, 0)};
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d ray = room_from_camera.linear() * camera.unproject(u, v, 1);
            double nearest = std::numeric_limits<double>::infinity();
            for (const Plane& plane : planes) {
                const double along = plane.normal.dot(ray);
                if (along >= -1e-9) continue;
                const double z = -plane.signed_distance(room_from_camera.translation()) / along;
                if (z > 0 && z < nearest) nearest = z;
            }
            if (!(nearest < info.depth_max_m)) continue;
            const Eigen::Vector3d p = room_from_camera.translation() + nearest * ray;
            double luma = 120;
            if (textured) luma = 20 + 110 * noise_at(p, 0.09, 1) + 100 * noise_at(p, 0.23, 2);
            frame.gray(u, v) = static_cast<std::uint8_t>(luma);
            frame.depth(u, v) = static_cast<std::uint16_t>(std::lround(nearest * info.depth_units_per_metre));
        }
    return frame;
}

/// All that is seen of a wall about 2 m ahead as one region, as the segmentation would give it.
inline PlanarRegion whole_view(const CameraInfo& camera, const DepthImage& depth) {
    PlanarRegion region;
    for (int v = 2; v < depth.height; v += 4) {
        for (int u = 2; u < depth.width; u += 4)
            region.moments.add(camera.color.unproject(u, v, camera.metres(depth(u, v))));
    }
    const PlaneFit fit = fit_plane(region.moments);
    region.plane = fit.plane;
    region.rms = fit.rms;
    region.box.frame_from_box.linear() = plane_axes(fit.plane.normal, {1, 0, 0});
    region.box.frame_from_box.translation() = fit.plane.project(region.moments.mean());
    region.box.half_extents = {1.2, 0.9, 0.01};
    region.outline.rings = {{{-1.2, -0.9}, {1.2, -0.9}, {1.2, 0.9}, {-1.2, 0.9}}};
    return region;
}

}  // namespace planemap::odometry
