// SPDX-License-Identifier: BSD-3-Clause
// Flat things to map: rectangles with holes, seen as the regions a segmentation would give.
#pragma once

#include <random>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap::scene {

/// A rectangle in the world: x and y of its frame along the sides, z the side that is seen.
struct Rectangle {
    Pose world_from_face = Pose::Identity();
    double half_x = 1, half_y = 1;
    std::vector<Ring> holes = {};  ///< in the face's x and y
};

/// A frame at `centre` with the given normal and x axis.
inline Pose facing(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, const Eigen::Vector3d& x) {
    Pose pose = Pose::Identity();
    pose.linear() = plane_axes(normal.normalized(), x);
    pose.translation() = centre;
    return pose;
}

inline Ring rectangle_ring(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

inline Outline outline_of(const Rectangle& r) {
    Outline outline{{rectangle_ring(-r.half_x, -r.half_y, r.half_x, r.half_y)}};
    outline.rings.insert(outline.rings.end(), r.holes.begin(), r.holes.end());
    return outline;
}

/// Points every `step` metres on the rectangle outside its holes, in the world, displaced along the normal by
/// noise of the given standard deviation.
inline std::vector<Eigen::Vector3d> points_on(const Rectangle& r, double step, double sigma,
                                              std::mt19937_64& random) {
    std::normal_distribution<double> noise(0, 1);
    const Outline outline = outline_of(r);
    std::vector<Eigen::Vector3d> points;
    for (double y = -r.half_y + step / 2; y < r.half_y; y += step) {
        for (double x = -r.half_x + step / 2; x < r.half_x; x += step) {
            if (!contains(outline, {x, y})) continue;
            points.push_back(r.world_from_face * Eigen::Vector3d(x, y, sigma * noise(random)));
        }
    }
    return points;
}

/// The rectangle as a region in the camera frame.
inline PlanarRegion region_of(const Rectangle& r, const Pose& world_from_camera, double step = 0.02,
                              double sigma = 0, std::uint64_t seed = 1) {
    std::mt19937_64 random(seed);
    const Pose camera_from_world = world_from_camera.inverse(Eigen::Isometry);
    PlanarRegion region;
    for (const Eigen::Vector3d& p : points_on(r, step, sigma, random))
        region.moments.add(camera_from_world * p);
    const PlaneFit fit = fit_plane(region.moments);
    region.plane = fit.plane;
    if (region.plane.normal.dot(camera_from_world.linear() * r.world_from_face.linear().col(2)) < 0)
        region.plane = region.plane.flipped();
    region.rms = fit.rms;
    region.box.frame_from_box = camera_from_world * r.world_from_face;
    region.box.half_extents = {r.half_x, r.half_y, 0.005};
    region.outline = outline_of(r);
    return region;
}

inline Keyframe keyframe(int id, const std::vector<Rectangle>& seen, const Pose& world_from_camera,
                         double sigma = 0) {
    Keyframe result;
    result.id = id;
    result.utime = 1000 * (id + 1);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::uint64_t seed = 100 * static_cast<std::uint64_t>(id) + i + 1;
        result.regions.push_back(region_of(seen[i], world_from_camera, 0.02, sigma, seed));
    }
    return result;
}

inline Pose camera_at(const Eigen::Vector3d& position, double turn = 0) {
    return make_pose(position,
                     Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d(0.3, 1, 0.2).normalized())));
}

}  // namespace planemap::scene
