// SPDX-License-Identifier: BSD-3-Clause
// Depth images of simple scenes with exact planes, for the tests of segmentation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/angle.hpp"
#include "core/geometry/moments.hpp"
#include "core/image.hpp"
#include "segmentation/segmenter.hpp"

namespace planemap::segmentation::scene {

/// Depth along the optical axis at which a ray (x, y, 1) meets a surface; infinity when it does not.
using Surface = std::function<double(const Eigen::Vector3d& ray)>;

inline constexpr double kMiss = std::numeric_limits<double>::infinity();

/// The plane, where `holds` is true of its points.
inline Surface plane(const Plane& p, std::function<bool(const Eigen::Vector3d&)> holds = {}) {
    return [=](const Eigen::Vector3d& ray) {
        const double along = p.normal.dot(ray);
        if (!(along < 0)) return kMiss;
        const double z = -p.d / along;
        return !holds || holds(ray * z) ? z : kMiss;
    };
}

/// A plane through `point` whose normal is turned from (0, 0, -1) by the angles about x and y, radians.
inline Plane tilted(double about_x, double about_y, const Eigen::Vector3d& point) {
    const Eigen::Vector3d n =
        Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
        (Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) * Eigen::Vector3d(0, 0, -1));
    return {n, -n.dot(point)};
}

inline Surface sphere(const Eigen::Vector3d& centre, double radius) {
    return [=](const Eigen::Vector3d& ray) {
        const double a = ray.squaredNorm(), b = ray.dot(centre), c = centre.squaredNorm() - radius * radius;
        const double root = b * b - a * c;
        return root < 0 ? kMiss : (b - std::sqrt(root)) / a;
    };
}

/// An upright cylinder (axis along y), without ends.
inline Surface cylinder(double x, double z, double radius) {
    return [=](const Eigen::Vector3d& ray) {
        const double a = ray.x() * ray.x() + 1, b = ray.x() * x + z, c = x * x + z * z - radius * radius;
        const double root = b * b - a * c;
        return root < 0 ? kMiss : (b - std::sqrt(root)) / a;
    };
}

/// A camera with 60 degrees of view across, millimetres.
inline CameraInfo camera(int width = 640, int height = 480) {
    CameraInfo info;
    const double f = 0.866 * width;
    info.depth = info.color = {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1)};
    return info;
}

/// Renders the nearest of the surfaces. With noise, a Kinect's: disparity with Gaussian noise of 0.3 steps,
/// rounded to steps of 0.00287 per metre.
inline DepthImage render(const CameraInfo& info, const std::vector<Surface>& surfaces, bool noise = false,
                         std::uint64_t seed = 1) {
    DepthImage depth(info.depth.width, info.depth.height);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> step(0, 0.3);
    constexpr double kStep = 0.00287;  // of inverse depth, per metre: 1/8 pixel at f = 580 and base 7.5 cm
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const Eigen::Vector3d ray = info.depth.unproject(u, v, 1);
            double z = kMiss;
            for (const Surface& surface : surfaces) {
                const double hit = surface(ray);
                if (hit > 0) z = std::min(z, hit);
            }
            if (noise) z = 1 / (kStep * std::round(1 / z / kStep + step(random)));
            const double raw = std::round(z * info.depth_units_per_metre);
            depth(u, v) = raw > 0 && raw < 65535 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
        }
    }
    return depth;
}

/// The region that lies on the plane, or null.
inline const PlanarRegion* find(const Segmentation& segmentation, const Plane& plane, double angle_deg = 2,
                                double distance_m = 0.03) {
    for (const PlanarRegion& region : segmentation.regions) {
        if (angle_between(region.plane.normal, plane.normal) < radians(angle_deg) &&
            std::abs(plane.signed_distance(region.moments.mean())) < distance_m)
            return &region;
    }
    return nullptr;
}

/// Sums over the labelled pixels, one by one.
inline Moments brute_force_moments(const DepthImage& depth, const CameraInfo& info,
                                   const Image<std::uint16_t>& labels, std::uint16_t label) {
    Moments moments;
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            if (labels(u, v) == label) moments.add(info.depth.unproject(u, v, info.metres(depth(u, v))));
        }
    }
    return moments;
}

/// Share of an image's pixels that carry a label.
inline double labelled_share(const Segmentation& segmentation) {
    const auto& pixels = segmentation.labels.pixels;
    return 1 - static_cast<double>(std::count(pixels.begin(), pixels.end(), 0)) /
                   static_cast<double>(pixels.size());
}

}  // namespace planemap::segmentation::scene
